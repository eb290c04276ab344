#pragma once
// The FreeVoxels library: draws volumes (clouds, smoke, scans) into images on a Vulkan device.
//
// A scene is JSON text with the keys of a scene file, or the options of `freevoxels render` by name (with -
// or _), in any mixture:
//   {"camera": {"orbit": [35, 25], "fov": 30}, "density-scale": 40, "light": {"direction": [1, 1, 1]}, "size": [800, 600]}
// Keys outside of sections override those inside. Keys that are left out have the command line's defaults. The images equal the
// command line's bit for bit. A whole scene file (loadScene) may be given everywhere: a function ignores sections that it cannot use,
// such as "output" where an image is drawn. Keys outside of sections that it cannot use are errors. All keys, their values and
// defaults are in share/doc/freevoxels/apps/scenes/README.md.
//
// Threads: any thread may call any function, with these exceptions. An object must not be assigned to, moved from or destroyed
// while another thread uses it; frames of one device are drawn one after another.
// Lifetimes: objects share what they need, so that they may be destroyed in any order. A moved-from object of any class may only be
// assigned to or destroyed. A device that the library opened is
// released with the last context, renderer and frame that uses it; the devices of renderers without a context stay open until the
// process ends.
// Failures are exceptions of type Error, or std::bad_alloc. The library prints nothing, installs no signal handlers, and reads
// the environment only for the folder of compiled pipelines (XDG_CACHE_HOME, HOME) and FREEVOXELS_VALIDATION.

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

#include "freevoxels/version.h"

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
  OutOfMemory = 6,
  Cancelled = 7  ///< the frame was cancelled
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

/// Called about every 50 ms, and at the end, with the name of a stage and the fraction of the frame that is done, an estimate that never
/// decreases and ends at 1. The thread that called render() calls it or, for a submitted frame, a thread of the renderer. An exception
/// that it throws cancels the work and is passed on to the caller. It may call functions of this library, also draw with another
/// renderer, whose frame it then waits for. ErrorKind::Usage is thrown by what might never end: drawing with the renderer that calls it,
/// and waiting for a submitted frame that is not complete. It must not destroy the renderer that calls it.
using Progress = std::function<void(std::string_view stage, double fraction)>;

struct ContextOptions {
  /// The device by its index in `freevoxels devices`, its UUID or a part of its name. Empty: a discrete GPU, then any GPU, then a
  /// CPU device.
  std::string device = {};
  int memoryLimit = 0;  ///< MiB of device memory that may be allocated; 0: all
  /// If set, the Vulkan validation layers are on and their messages are passed to it, by any thread, in the middle of a call of Vulkan:
  /// nothing can be drawn or opened there. For debugging.
  std::function<void(std::string_view message)> validationLog = nullptr;
};

struct AdoptedDevice;

/// A Vulkan device, which renderers share: one that is opened here, or the caller's own (adopt() in freevoxels/vulkan.h). Copies
/// refer to the same device.
class FREEVOXELS_API Context {
 public:
  /// Throws ErrorKind::Device where no device fits `options`, with the reason for each.
  explicit Context(const ContextOptions& options = {});
  std::string device() const;  ///< its name

 private:
  struct State;
  friend class Volume;
  friend class Renderer;
  friend class Sequence;
  friend FREEVOXELS_API Context adopt(const AdoptedDevice& device, int memoryLimit);
  explicit Context(std::shared_ptr<State> state) : state_(std::move(state)) {}
  std::shared_ptr<State> state_;
};

/// The place of a box of values in the world.
struct Placement {
  std::array<double, 3> spacing{1.0, 1.0, 1.0};  ///< world units between voxels along x, y and z
  std::array<double, 3> origin{0.0, 0.0, 0.0};   ///< world position of the centre of voxel (0, 0, 0)
};

/// A volume in memory, or a baked file that is open. Copies share its data.
class FREEVOXELS_API Volume {
 public:
  /// Reads an OpenVDB file or a scan, a folder of DICOM files included, or makes "procedural:NAME"; if `file` is empty, that of the scene's
  /// key "volume". `scene` names the grid, the resolution and what to read of a scan (spacing, raw, series, time-step, pyramid-level), and
  /// has the keys of later frames: emission, temperature-grid and albedo-grid decide which further grids are read. A volume that the device
  /// cannot hold is drawn piece by piece. The values of a baked volume are read when it is drawn, from the level of detail that the frame
  /// needs; its file must not be changed meanwhile.
  static Volume open(const Context& context, const std::filesystem::path& file, std::string_view scene = "{}");
  /// The same for renderers of any device, none of which is opened here.
  static Volume open(const std::filesystem::path& file, std::string_view scene = "{}");
  /// Copies the values of a box of `dimensions` (x, y, z) voxels, x fastest. NaN means no data. `scene`: its keys
  /// "labels" and "channels" say what the values are; the boxes of channels, whose names are their numbers from 0 on, follow each other.
  static Volume copy(std::span<const float> values, std::array<int, 3> dimensions, const Placement& placement = {},
                     std::string_view scene = "{}");

  std::array<int, 3> dimensions() const;   ///< voxels along x, y and z
  std::uint64_t activeVoxels() const;      ///< voxels with data
  std::pair<float, float> range() const;   ///< smallest and largest of their values
  std::string source() const;              ///< file and grid, for messages
  /// What the user should know of how the file was read, in sentences: NaN values, a grid chosen among several.
  std::vector<std::string> warnings() const;
  /// What was assumed of the file where it leaves that open, and the keys of a scene that say otherwise, in one line: which grids have the
  /// densities, temperatures and colours, and a scan's value of no data. Empty if nothing was.
  std::string remarks() const;

 private:
  struct State;
  friend class Renderer;
  friend FREEVOXELS_API void bake(const Volume& volume, const std::filesystem::path& file, std::string_view scene, const Progress& progress);
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

/// Surfaces from elsewhere in front of which volumes are drawn, in place of the scene's key "holdout": the rays of a pixel end at its
/// depth. Functions copy the depths. None if there are none.
struct Holdout {
  int width = 0, height = 0;  ///< of the image to be drawn
  /// One value a pixel, top row first, as Image::depth has them: the distance along the viewing axis, in world units; infinite, or beyond
  /// the volume, where nothing is in front. ErrorKind::Input for NaN and for values below 0.
  std::span<const float> depths = {};
};

/// What a frame is drawn with besides its scene.
struct FrameOptions {
  bool depth = false;  ///< whether Image::depth is made
  Progress progress = {};
  Holdout holdout = {};
  /// Milliseconds within which the frame is to be drawn, while something moves; 0 draws the frame of the scene. Its quality, in place of
  /// the scene's key "quality", follows from the times of the renderer's frames before, so that only the first ones after a change take
  /// longer. A draft after another transfer function may have the light of the one before. ErrorKind::Usage below 0.
  double budget = 0.0;
};

struct DeviceFrame;

/// A frame begun by Renderer::submit(), which a thread of the renderer draws.
class FREEVOXELS_API Frame {
 public:
  Frame(Frame&&) noexcept;
  Frame& operator=(Frame&&) noexcept;
  /// Cancels the frame if it is not complete, without waiting. Its images on the device may be drawn into again.
  ~Frame();

  /// Whether wait() returns or throws at once.
  bool ready() const;
  /// Waits until the frame is complete. Throws the error for which it cannot be drawn.
  void wait() const;
  /// Abandons the frame if it is not complete, within about 50 ms. wait() then throws ErrorKind::Cancelled.
  void cancel();
  /// Waits, and copies the image to the host.
  Image image() const;

 private:
  struct State;
  friend class Renderer;
  friend FREEVOXELS_API DeviceFrame deviceFrame(const Frame& frame);
  explicit Frame(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Draws images of one volume. The scene of the renderer gives the view: the distance of the eye, the look-at point and the default
/// lights. The "orbit" of a frame turns the eye around that point. What frames share, such as the attenuation table, stays on the device
/// and is made again only if a frame's scene changes it.
class FREEVOXELS_API Renderer {
 public:
  /// `scene` holds for every frame. Throws ErrorKind::Usage or Input for what is wrong in it, and OutOfMemory with what the volume needs.
  Renderer(const Context& context, Volume volume, std::string_view scene = "{}");
  /// The same on the device of the keys "device" and "memory-limit", which this constructor opens unless it is open already. Throws
  /// ErrorKind::Device where none fits.
  explicit Renderer(Volume volume, std::string_view scene = "{}");
  /// Cancels the submitted frames that are not complete.
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws a frame and waits for it. The keys of `scene` override those of the renderer's scene for this frame. Throws ErrorKind::Usage or
  /// Input for what is wrong in it, OutOfMemory with what the frame needs, and Device if the device is lost.
  Image render(std::string_view scene = "{}", const FrameOptions& options = {});
  /// Draws frame `frame` of a full turn of `frames`, with the cameras and the light of `freevoxels turntable`: the eye is as far away in
  /// all of them as the farthest needs. With the key "flight" it is frame `frame` of a flight through key frames of camera and lights.
  /// The flight's file is read for the first frame that is drawn of it, and again where that frame is drawn again, or a frame of another
  /// scene or number of frames was drawn in between by this function.
  Image renderTurn(int frame, int frames, std::string_view scene = "{}", const FrameOptions& options = {});
  /// Begins the same frame as render() and returns at once. Frames of a renderer are drawn in the order in which they were submitted.
  /// Throws for errors of `scene`; Frame::wait() throws those of drawing.
  Frame submit(std::string_view scene = "{}", const FrameOptions& options = {});

  /// The camera of the last complete frame, as the text of a scene that gives it. "{}" before the first frame.
  std::string camera() const;
  /// Milliseconds of the stages that the last complete frame ran. Waits for nothing.
  std::vector<std::pair<std::string, double>> timings() const;
  /// The name of the Vulkan device.
  std::string device() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The frames of a film: volumes whose file names differ in a number. They are seen as `freevoxels render 'smoke_####.vdb'` shows them:
/// what the scene leaves open of camera, lights and scales is chosen for the film as a whole, for which the first image reads up to 12
/// frames. The scene has the keys of Volume::open and of Renderer, and
///   "frames": "A-B:STEP", "A-B", "A-" or a number: which numbers of the files are drawn; else all;
///   "fixed-view": true: the view and the scales of the first frame that holds anything; false: each frame is seen by itself.
/// Two volumes are never in memory at once.
class FREEVOXELS_API Sequence {
 public:
  /// `names` are patterns, in which a run of # (or %04d) stands for the number, and files; if there are none, the scene's key "volume".
  /// Fails with ErrorKind::Input where a pattern has no file. No file is read yet.
  Sequence(const Context& context, const std::vector<std::string>& names, std::string_view scene = "{}");
  /// The same on the device of the keys "device" and "memory-limit".
  explicit Sequence(const std::vector<std::string>& names, std::string_view scene = "{}");
  ~Sequence();
  Sequence(Sequence&&) noexcept;
  Sequence& operator=(Sequence&&) noexcept;

  std::size_t size() const;                 ///< how many frames there are, at least 1
  std::vector<std::string> files() const;   ///< the file, or procedural:NAME, of each frame, in the order of the numbers
  std::vector<double> numbers() const;      ///< of each frame: that in the name of its file, or the place in `names`

  /// Draws a frame, from 0 to size() - 1, and waits for it. `scene` as for Renderer::render(): its "orbit" moves the eye about the film's
  /// look-at point. The frame drawn last stays in memory. In a film of several, one that holds nothing is transparent everywhere; a file
  /// that cannot be read fails with ErrorKind::Input, and other frames may be drawn afterwards.
  Image render(std::size_t frame, std::string_view scene = "{}", const FrameOptions& options = {});
  /// Draws all frames and writes each, when it is complete, into one file for each of `images`, in whose name a run of # stands for the
  /// number. `scene` is as for freevoxels::v1::save(), and "aov" adds channels to an .exr. `skipExisting`: frames whose files exist are left
  /// as they are. Files that cannot be read are left out; ErrorKind::Input is thrown at the end. Returns the names of the images. The
  /// fraction that `progress` gets is that of all frames.
  std::vector<std::string> save(const std::vector<std::string>& images, std::string_view scene = "{}", bool skipExisting = false,
                                const Progress& progress = {});

  /// The camera, the times and the device of the last complete frame, as Renderer has them.
  std::string camera() const;
  std::vector<std::pair<std::string, double>> timings() const;
  std::string device() const;
  /// What the user should know, in sentences, each once: numbers without a file, and what is remarkable about the files read so far.
  std::vector<std::string> warnings() const;
  /// What was chosen for the film and assumed of the files read so far, each sentence once.
  std::vector<std::string> remarks() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes a .png (8-bit sRGB over a background) or an .exr (linear, with depth if the image has it),
/// atomically. `scene` has background, exposure, tone-map and float.
FREEVOXELS_API void save(const std::filesystem::path& file, const Image& image, std::string_view scene = "{}");

/// Bakes a volume as `freevoxels bake` does: classifies it once and writes a file, whose name ends in .fvx, that opens at once and may be
/// larger than memory. `volume` is a file or "procedural:NAME"; if it is empty, the scene's key "volume". `scene` has the keys grid,
/// resolution, those of the sections classification and emission, and
///   "keep-scalars": true, for values as 32-bit floats, so that the classification can still be changed; "compress": true.
FREEVOXELS_API void bake(const std::filesystem::path& volume, const std::filesystem::path& file, std::string_view scene = "{}",
                         const Progress& progress = {});
/// Bakes a volume that is open. `scene` has no keys of the volume.
FREEVOXELS_API void bake(const Volume& volume, const std::filesystem::path& file, std::string_view scene = "{}", const Progress& progress = {});

/// Writes the values of a volume, before they are classified, as `freevoxels convert` does: `file` ends in .vdb, .nrrd, .nii or .nii.gz.
/// `scene` has the keys of the section "input". `progress` may abandon reading by an exception, which is passed on.
FREEVOXELS_API void convert(const std::filesystem::path& volume, const std::filesystem::path& file, std::string_view scene = "{}",
                            const Progress& progress = {});

/// What a file or "procedural:NAME" holds: the text of `freevoxels info --json`. `scene` has the key "resolution" and those of scans, and
/// "check": true reads all of a baked volume and fails with ErrorKind::Input where anything is damaged.
FREEVOXELS_API std::string info(const std::filesystem::path& volume, std::string_view scene = "{}");

/// The Vulkan devices of this machine: the text of `freevoxels devices --json`.
FREEVOXELS_API std::string devices();

/// The transfer functions that "transfer-function" takes by name: the text of `freevoxels presets --json`, an object of functions by their
/// names, of which the key "description" says what each is for. Each of them is a value of "transfer-function", too.
FREEVOXELS_API std::string presets();

/// Adds up the files of sums that `freevoxels render --share I/N --sums` wrote, and writes the image, as `freevoxels merge` does. `scene`
/// as for save().
FREEVOXELS_API void merge(const std::vector<std::string>& parts, const std::vector<std::string>& images, std::string_view scene = "{}");

/// Reads a scene file, which the command line, the viewer or saveScene() wrote, or a person: the text of a scene, with absolute
/// names of files. Fails with ErrorKind::Input and a sentence that names the file and the key.
FREEVOXELS_API std::string loadScene(const std::filesystem::path& file);
/// What a user should know of a scene file: which keys are of an earlier version and have no effect.
FREEVOXELS_API std::vector<std::string> sceneWarnings(const std::filesystem::path& file);
/// Writes a scene as a file for the command line and the viewer, with names of files relative to its folder, atomically.
FREEVOXELS_API void saveScene(const std::filesystem::path& file, std::string_view scene);

/// The version of the library, such as "0.1.0"; that of this header is FREEVOXELS_VERSION.
FREEVOXELS_API std::string version();

}  // namespace freevoxels::v1
