#pragma once
// The FreeVoxels library: volumes in, images out. Includes the standard library only.
//
// A scene is text: the JSON of a scene file, or the options of `freevoxels render` by name, with - or _, in any mixture:
//   {"camera": {"orbit": [35, 25], "fov": 30}, "density-scale": 40, "light": {"direction": [1, 1, 1]}, "size": [800, 600]}
// What it leaves out has the default of the command line, and both make the same image to the bit.
//
// Every function may be called by any thread; frames of one device are drawn one after another. Failures are Error, but for
// std::bad_alloc of the standard library. The device is opened by the first call that needs it, and kept until the process ends.

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

/// what() is one sentence that names the file or option, and the remedy.
class FREEVOXELS_API Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& sentence) : std::runtime_error(sentence), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

/// Called with the name of a stage and how much of the work is done, 0..1, about every 50 ms of it. An exception that it throws
/// abandons the work and reaches the caller.
using Progress = std::function<void(std::string_view stage, double fraction)>;

/// Where a box of values stands in the world.
struct Placement {
  std::array<double, 3> spacing{1.0, 1.0, 1.0};  ///< world units between voxels along x, y and z
  std::array<double, 3> origin{0.0, 0.0, 0.0};   ///< world position of the centre of voxel (0, 0, 0)
};

/// A volume in memory. Copies share it.
class FREEVOXELS_API Volume {
 public:
  /// Reads an OpenVDB file, or makes "procedural:NAME". `scene`: grid, resolution, and the scene of frames to come, of
  /// which emission, temperature-grid and albedo-grid add grids to read.
  static Volume open(const std::filesystem::path& file, std::string_view scene = "{}");
  /// Copies as many values as `dimensions` (x, y, z) has voxels, x fastest. NaN holds no data.
  static Volume copy(std::span<const float> values, std::array<int, 3> dimensions, const Placement& placement = {});

  std::array<int, 3> dimensions() const;   ///< voxels along x, y and z
  std::uint64_t activeVoxels() const;      ///< that hold data
  std::pair<float, float> range() const;   ///< the least and the largest of their values
  std::string source() const;              ///< file and grid, for messages

 private:
  struct State;
  friend class Renderer;
  explicit Volume(std::shared_ptr<const State> state) : state_(std::move(state)) {}
  std::shared_ptr<const State> state_;
};

struct Image {
  int width = 0, height = 0;
  /// Four a pixel: linear Rec.709 red, green and blue, multiplied by alpha, and alpha; row 0 is the top.
  std::vector<float> pixels;
  /// Empty, or one a pixel: mean distance along the viewing axis, in world units, of what is seen; infinite where there is nothing.
  std::vector<float> depth;
};

/// Draws one volume many times. What its frames have in common, the attenuation table above all, stays on the device and is made
/// again only for a frame whose scene changes it.
class FREEVOXELS_API Renderer {
 public:
  /// `scene` holds for every frame.
  explicit Renderer(Volume volume, std::string_view scene = "{}");
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// `scene` takes the place of what the renderer's scene says of the same keys, for this frame.
  Image render(std::string_view scene = "{}", bool withDepth = false, const Progress& progress = {});

  /// Stage and milliseconds, of what the last frame is drawn from and of that frame.
  std::vector<std::pair<std::string, double>> timings() const;
  /// Name of the Vulkan device.
  std::string device() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes a .png, 8-bit sRGB over a background, or an .exr, linear, with depth where the image has it. The file is complete or
/// not there. `scene`: background, exposure, tone-map, float.
FREEVOXELS_API void save(const std::filesystem::path& file, const Image& image, std::string_view scene = "{}");

/// "0.1.0"
FREEVOXELS_API std::string version();

}  // namespace freevoxels::v1
