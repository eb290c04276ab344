#pragma once
// The FreeVoxels library: volumes in, images out. Includes the standard library only.
//
// A scene is JSON text with the keys of a scene file, or the options of `freevoxels render` by name (with -
// or _), in any mixture:
//   {"camera": {"orbit": [35, 25], "fov": 30}, "density-scale": 40, "light": {"direction": [1, 1, 1]}, "size": [800, 600]}
// Keys that are left out have the command line's defaults. The images equal the command line's bit for bit.
//
// Any thread may call any function; frames of one device are drawn one after another. Failures are exceptions
// of type Error, or std::bad_alloc. The device is opened by the first call that needs it, and kept until the
// process ends.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#if defined(__GNUC__)
#define FREEVOXELS_API __attribute__((visibility("default")))
#else
#define FREEVOXELS_API
#endif

namespace freevoxels::v1 {

enum class ErrorKind : int {
  Internal = 1,  ///< a bug of the library
  Usage = 2,     ///< an option does not exist, or contradicts others
  Input = 3,     ///< a file, an array or a value cannot be used
  Output = 4,    ///< a file cannot be written
  Device = 5,    ///< there is no such Vulkan device, or it failed
  OutOfMemory = 6
};

/// what() is one sentence that names the file or key of the scene and the remedy.
class FREEVOXELS_API Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& sentence, std::vector<std::string> parameters = {})
      : std::runtime_error(sentence), kind_(kind), parameters_(std::move(parameters)) {}
  ErrorKind kind() const { return kind_; }
  /// The keys of scenes that the sentence names, such as "memory-limit": which to change, or which were given wrongly.
  const std::vector<std::string>& parameters() const { return parameters_; }

 private:
  ErrorKind kind_;
  std::vector<std::string> parameters_;
};

/// Called about every 50 ms with the name of a stage and the fraction of the work that is done, 0..1. An
/// exception that it throws cancels the work and is passed on to the caller.
using Progress = std::function<void(std::string_view stage, double fraction)>;

/// The place of a box of values in the world.
struct Placement {
  std::array<double, 3> spacing{1.0, 1.0, 1.0};  ///< world units between voxels along x, y and z
  std::array<double, 3> origin{0.0, 0.0, 0.0};   ///< world position of the centre of voxel (0, 0, 0)
};

/// A volume in memory. Copies share its data.
class FREEVOXELS_API Volume {
 public:
  /// Reads an OpenVDB file, or makes "procedural:NAME". `scene` has the grid, the resolution, and the scene
  /// of later frames, of which emission, temperature-grid and albedo-grid decide what other grids are read.
  static Volume open(const std::filesystem::path& file, std::string_view scene = "{}");
  /// Copies the values of a box of `dimensions` (x, y, z) voxels, x fastest. NaN means no data.
  static Volume copy(std::span<const float> values, std::array<int, 3> dimensions, const Placement& placement = {});

  std::array<int, 3> dimensions() const;   ///< voxels along x, y and z
  std::uint64_t activeVoxels() const;      ///< voxels with data
  std::pair<float, float> range() const;   ///< smallest and largest of their values
  std::string source() const;              ///< file and grid, for messages

 private:
  struct State;
  friend class Renderer;
  explicit Volume(std::shared_ptr<const State> state) : state_(std::move(state)) {}
  std::shared_ptr<const State> state_;
};

struct Image {
  int width = 0, height = 0;
  /// Four values a pixel, top row first: linear Rec.709 red, green and blue, multiplied by alpha; and alpha.
  std::vector<float> pixels;
  /// Empty, or one value a pixel: the mean distance along the viewing axis, in world units, of what is seen;
  /// infinite where nothing is seen.
  std::vector<float> depth;
};

/// Draws images of one volume. What frames share, such as the attenuation table, stays on the device and is
/// made again only if a frame's scene changes it.
class FREEVOXELS_API Renderer {
 public:
  /// `scene` holds for every frame.
  explicit Renderer(Volume volume, std::string_view scene = "{}");
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws a frame. The keys of `scene` override those of the renderer's scene for this frame.
  Image render(std::string_view scene = "{}", bool withDepth = false, const Progress& progress = {});

  /// Stages and milliseconds of the last frame and of the data from which it was drawn.
  std::vector<std::pair<std::string, double>> timings() const;
  /// The name of the Vulkan device.
  std::string device() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes a .png (8-bit sRGB over a background) or an .exr (linear, with depth if the image has it),
/// atomically. `scene` has background, exposure, tone-map and float.
FREEVOXELS_API void save(const std::filesystem::path& file, const Image& image, std::string_view scene = "{}");

/// The version, such as "0.1.0".
FREEVOXELS_API std::string version();

}  // namespace freevoxels::v1
