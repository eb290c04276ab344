// The public interface. No exception type of the engine leaves it.

#include <fmt/ranges.h>
#include <volk.h>

#include <cmath>

#include "apps/common/frame_queue.h"
#include "apps/common/program.h"
#include "apps/common/scene_renderer.h"
#include "apps/common/scene_sequence.h"
#include "apps/common/scene_tools.h"
#include "apps/library/include/freevoxels/freevoxels.h"
#include "apps/library/include/freevoxels/vulkan.h"
#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/core/printable.h"
#include "engine/volume/volume_of_scalars.h"
#include "engine/vulkan/device_requirements.h"

namespace freevoxels::v1 {

namespace {

using Json = nlohmann::json;

ErrorKind kindOf(freevoxels::ErrorKind kind) {
  switch (kind) {
    case freevoxels::ErrorKind::Usage: return ErrorKind::Usage;
    case freevoxels::ErrorKind::Input: return ErrorKind::Input;
    case freevoxels::ErrorKind::Output: return ErrorKind::Output;
    case freevoxels::ErrorKind::Device: return ErrorKind::Device;
    case freevoxels::ErrorKind::OutOfMemory: return ErrorKind::OutOfMemory;
    default: return ErrorKind::Internal;
  }
}

/// The text with its parameters as keys of a scene: "memory-limit", "draw": "splats".
std::string withSceneKeys(std::string_view text) {
  return spelled(text, [](std::string_view name, std::string_view value) {
    return value.empty() ? fmt::format("\"{}\"", name) : fmt::format("\"{}\": \"{}\"", name, value);
  });
}

/// Calls `work` and converts the engine's errors to those of this interface.
template <typename Work>
auto translated(const Work& work) {
  try {
    return work();
  } catch (const freevoxels::Error& error) {
    throw Error(kindOf(error.kind()), printable(withSceneKeys(error.text())), error.parameters());
  } catch (const InternalError& error) {
    throw Error(ErrorKind::Internal, fmt::format("internal error, please report it: {}", error.what()));
  } catch (const FrameCancelled&) {
    throw Error(ErrorKind::Cancelled, "the frame was cancelled before it was complete");
  }
}

Json parseScene(std::string_view text) {
  if (isTooDeep(text)) fail(freevoxels::ErrorKind::Usage, "a scene is nested at most {} deep, and this one is deeper", kDeepestJson);
  Json scene = parseJson("scene", "inline", text);
  constexpr std::size_t kLongestQuote = 200;
  if (!scene.is_object()) fail(freevoxels::ErrorKind::Usage, "a scene is a JSON object, as '{{\"size\": [800, 600]}}', not '{}'", printablePart(text, kLongestQuote));
  return scene;
}

freevoxels::Volume volumeOf(std::span<const float> values, std::array<int, 3> dimensions, const Placement& placement) {
  const auto& [x, y, z] = dimensions;
  if (std::min({x, y, z}) < 1 || std::size_t(x) * std::size_t(y) * std::size_t(z) != values.size())
    fail(freevoxels::ErrorKind::Input, "{} values are not a box of {} x {} x {} voxels", values.size(), x, y, z);
  const auto vector = [](const std::array<double, 3>& v) { return glm::dvec3(v[0], v[1], v[2]); };
  const glm::ivec3 size(x, y, z);
  return volumeOfScalars(ScalarBricks::make(size,
                                            [&](glm::ivec3 voxel) {
                                              const std::size_t row = std::size_t(voxel.y) + std::size_t(y) * std::size_t(voxel.z);
                                              const float value = values[std::size_t(voxel.x) + std::size_t(x) * row];
                                              return std::isnan(value) ? kInactiveVoxel : value;
                                            }),
                         latticeTransform(vector(placement.spacing), vector(placement.origin)), false);
}

Image imageOf(freevoxels::Image image) {
  const float* const first = reinterpret_cast<const float*>(image.pixels.data());
  return {image.size.x, image.size.y, {first, first + 4 * image.pixels.size()}, std::move(image.depth)};
}

std::vector<std::pair<std::string, double>> pairsOf(const std::vector<StageTime>& times) {
  std::vector<std::pair<std::string, double>> pairs;
  for (const StageTime& time : times) pairs.emplace_back(time.name, time.milliseconds);
  return pairs;
}

/// Sentences that are told while frames are drawn, each once.
class Told {
 public:
  void add(std::string sentence) {
    const std::lock_guard lock(mutex_);
    if (std::ranges::find(sentences_, sentence) == sentences_.end()) sentences_.push_back(std::move(sentence));
  }
  std::vector<std::string> all() const {
    const std::lock_guard lock(mutex_);
    return sentences_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> sentences_;
};

DeviceOptions limited(int mebibytes) {
  DeviceOptions options;
  if (mebibytes < 0) fail(freevoxels::ErrorKind::Usage, "a limit of {} MiB on device memory is below 0: 0 is no limit", mebibytes);
  if (mebibytes > 0) options.memoryLimit = mebibytes;
  return options;
}

}  // namespace

struct Context::State {
  std::shared_ptr<DeviceContext> context;
};

struct Volume::State {
  std::shared_ptr<const SharedVolume> volume;
};

struct Frame::State {
  std::shared_ptr<SubmittedFrame> frame;
};

struct Renderer::State {
  SceneRenderer renderer;
  FrameQueue queue;  // last, as it draws with `renderer`
};

struct Sequence::State {
  State(const std::vector<std::string>& names, Json scene, std::shared_ptr<DeviceContext> context)
      : sequence(names, std::move(scene),
                 [this](const std::string& sentence, bool isWarning) {
                   (isWarning ? warnings : remarks).add(printable(withSceneKeys(sentence)));
                 },
                 std::move(context)) {}

  Told warnings, remarks;
  SceneSequence sequence;  // last, as it tells the others
};

Context::Context(const ContextOptions& options)
    : state_(translated([&] {
        DeviceOptions device = limited(options.memoryLimit);
        if (!options.device.empty()) device.selector = options.device;
        return std::make_shared<State>(State{std::make_shared<DeviceContext>(device, options.validationLog)});
      })) {}

std::string Context::device() const {
  return state_->context->device->description().name;
}

Context adopt(const AdoptedDevice& adopted, int memoryLimit) {
  return translated([&] {
    if (adopted.instance == VK_NULL_HANDLE || adopted.physicalDevice == VK_NULL_HANDLE || adopted.device == VK_NULL_HANDLE ||
        adopted.queue == VK_NULL_HANDLE || adopted.features == nullptr)
      fail(freevoxels::ErrorKind::Usage, "an adopted device needs its instance, physical device, device, queue and features: one is null");
    const freevoxels::AdoptedDevice device{.physical = adopted.physicalDevice,
                                           .device = adopted.device,
                                           .queue = adopted.queue,
                                           .queueFamily = adopted.queueFamily,
                                           .features = adopted.features,
                                           .queueMutex = adopted.queueMutex};
    return Context(std::make_shared<Context::State>(
        Context::State{std::make_shared<DeviceContext>(adopted.instance, device, limited(memoryLimit))}));
  });
}

std::string whyUnusable(VkInstance instance, VkPhysicalDevice device) {
  return translated([&] {
    const Instance adopted(instance);
    return fmt::format("{}", fmt::join(findRejections(device), ", "));
  });
}

std::span<const char* const> requiredExtensions() {
  return freevoxels::requiredExtensions();
}

void enableRequiredFeatures(VkPhysicalDeviceFeatures2& chain) {
  translated([&] { freevoxels::enableRequiredFeatures(chain); });
}

Volume Volume::open(const Context& context, const std::filesystem::path& file, std::string_view scene) {
  return translated([&] {
    return Volume(std::make_shared<const State>(openVolume(file.string(), parseScene(scene), context.state_->context)));
  });
}

Volume Volume::open(const std::filesystem::path& file, std::string_view scene) {
  return translated([&] { return Volume(std::make_shared<const State>(openVolume(file.string(), parseScene(scene)))); });
}

Volume Volume::copy(std::span<const float> values, std::array<int, 3> dimensions, const Placement& placement) {
  return translated([&] {
    return Volume(std::make_shared<const State>(
        std::make_shared<const SharedVolume>(volumeOf(values, dimensions, placement))));
  });
}

std::array<int, 3> Volume::dimensions() const {
  const glm::ivec3 size = state_->volume->describe().dimensions;
  return {size.x, size.y, size.z};
}

std::uint64_t Volume::activeVoxels() const {
  return state_->volume->describe().activeVoxels;
}

std::pair<float, float> Volume::range() const {
  return {state_->volume->describe().minimum, state_->volume->describe().maximum};
}

std::string Volume::source() const {
  return state_->volume->describe().source;
}

std::vector<std::string> Volume::warnings() const {
  std::vector<std::string> warnings = warningsOf(state_->volume->describe(), false);
  for (std::string& warning : warnings) warning = printable(withSceneKeys(warning));
  return warnings;
}

std::string Volume::remarks() const {
  return printable(withSceneKeys(remarksOf(state_->volume->describe())));
}

Frame::Frame(std::unique_ptr<State> state) : state_(std::move(state)) {}
Frame::Frame(Frame&&) noexcept = default;

Frame& Frame::operator=(Frame&& other) noexcept {
  const Frame replaced(std::move(*this));
  state_ = std::move(other.state_);
  return *this;
}

Frame::~Frame() {
  if (state_) state_->frame->cancel();
}

bool Frame::ready() const {
  return state_->frame->ready();
}

void Frame::wait() const {
  translated([&] { state_->frame->wait(); });
}

void Frame::cancel() {
  state_->frame->cancel();
}

Image Frame::image() const {
  return translated([&] { return imageOf(downloadImage(*state_->frame->context().device, state_->frame->targets())); });
}

DeviceFrame deviceFrame(const Frame& frame) {
  return translated([&] {
    if (!frame.state_->frame->context().isAdopted)
      fail(freevoxels::ErrorKind::Usage, "the frame is on a device of the library's own: create its renderer with a context from adopt()");
    const SubmittedFrame& drawn = *frame.state_->frame;
    const auto handles = [](const RenderTarget& target) { return DeviceFrame::Image{target.handle(), target.view(), target.format()}; };
    const FrameTargets& targets = drawn.targets();
    const glm::uvec2 size(targets.colorEnergy.size());
    return DeviceFrame{.color = handles(targets.colorEnergy),
                       .depth = handles(targets.distance),
                       .extent = {size.x, size.y},
                       .semaphore = drawn.context().device->queue().timeline(),
                       .value = drawn.completion()};
  });
}

Renderer::Renderer(const Context& context, Volume volume, std::string_view scene)
    : state_(translated([&] {
        return std::unique_ptr<State>(new State{SceneRenderer(volume.state_->volume, parseScene(scene), context.state_->context), {}});
      })) {}

Renderer::Renderer(Volume volume, std::string_view scene)
    : state_(translated([&] {
        return std::unique_ptr<State>(new State{SceneRenderer(volume.state_->volume, parseScene(scene)), {}});
      })) {}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::render(std::string_view scene, bool withDepth, const Progress& progress) {
  return translated([&] {
    SceneRenderer& renderer = state_->renderer;
    return imageOf(renderer.render(*renderer.read(parseScene(scene)), {.depth = withDepth}, progress));
  });
}

Image Renderer::renderTurn(int frame, int frames, std::string_view scene, bool withDepth, const Progress& progress) {
  return translated([&] {
    if (frames < 1 || frames > kMaximumFrames || frame < 0 || frame >= frames)
      fail(freevoxels::ErrorKind::Usage, "frame {} is not one of {} {}, which are numbered from 0: there are 1 to {}", frame, frames,
           Parameter("frames"), kMaximumFrames);
    SceneRenderer& renderer = state_->renderer;
    return imageOf(renderer.renderTurn(*renderer.read(parseScene(scene)), {frame, frames}, {.depth = withDepth}, progress));
  });
}

std::string Renderer::camera() const {
  return state_->renderer.camera().dump();
}

Frame Renderer::submit(std::string_view scene, bool withDepth, Progress progress) {
  return translated([&] {
    SceneRenderer& renderer = state_->renderer;
    std::shared_ptr<const KeywordOptions> options = renderer.read(parseScene(scene));
    auto frame = std::make_shared<SubmittedFrame>(
        renderer.context(),
        [&renderer, options = std::move(options), withDepth](const freevoxels::Progress& report) {
          return renderer.renderOnDevice(*options, withDepth, report);
        },
        std::move(progress));
    state_->queue.submit(frame);
    return Frame(std::unique_ptr<Frame::State>(new Frame::State{std::move(frame)}));
  });
}

std::vector<std::pair<std::string, double>> Renderer::timings() const {
  return pairsOf(state_->renderer.timings());
}

std::string Renderer::device() const {
  return state_->renderer.context()->device->description().name;
}

Sequence::Sequence(const Context& context, const std::vector<std::string>& names, std::string_view scene)
    : state_(translated([&] { return std::make_unique<State>(names, parseScene(scene), context.state_->context); })) {}

Sequence::Sequence(const std::vector<std::string>& names, std::string_view scene)
    : state_(translated([&] { return std::make_unique<State>(names, parseScene(scene), nullptr); })) {}

Sequence::~Sequence() = default;
Sequence::Sequence(Sequence&&) noexcept = default;
Sequence& Sequence::operator=(Sequence&&) noexcept = default;

std::size_t Sequence::size() const {
  return state_->sequence.volumes().size();
}

std::vector<std::string> Sequence::files() const {
  std::vector<std::string> files;
  for (const NumberedVolume& volume : state_->sequence.volumes()) files.push_back(volume.file);
  return files;
}

std::vector<double> Sequence::numbers() const {
  std::vector<double> numbers;
  for (const NumberedVolume& volume : state_->sequence.volumes()) numbers.push_back(volume.number.value);
  return numbers;
}

Image Sequence::render(std::size_t frame, std::string_view scene, bool withDepth, const Progress& progress) {
  return translated([&] {
    if (frame >= size()) fail(freevoxels::ErrorKind::Usage, "there is no frame {}: the sequence has {}, numbered from 0", frame, size());
    SceneSequence& sequence = state_->sequence;
    return imageOf(sequence.render(frame, *sequence.read(parseScene(scene)), {.depth = withDepth}, progress));
  });
}

std::vector<std::string> Sequence::save(const std::vector<std::string>& images, std::string_view scene, bool skipExisting,
                                        const Progress& progress) {
  return translated([&] { return state_->sequence.save(images, parseScene(scene), skipExisting, progress); });
}

std::string Sequence::camera() const {
  return state_->sequence.camera().dump();
}

std::vector<std::pair<std::string, double>> Sequence::timings() const {
  return pairsOf(state_->sequence.timings());
}

std::string Sequence::device() const {
  return state_->sequence.context()->device->description().name;
}

std::vector<std::string> Sequence::warnings() const {
  return state_->warnings.all();
}

std::vector<std::string> Sequence::remarks() const {
  return state_->remarks.all();
}

void save(const std::filesystem::path& file, const Image& image, std::string_view scene) {
  translated([&] {
    const std::size_t pixels = std::size_t(std::max(image.width, 0)) * std::size_t(std::max(image.height, 0));
    if (pixels == 0 || image.pixels.size() != 4 * pixels || (!image.depth.empty() && image.depth.size() != pixels))
      fail(freevoxels::ErrorKind::Input, "an image of {} x {} pixels has {} values and {} depths: it needs 4 values, and 1 depth or none, a pixel",
           image.width, image.height, image.pixels.size(), image.depth.size());
    freevoxels::Image copy{.size = {image.width, image.height}, .pixels = std::vector<glm::vec4>(pixels), .depth = image.depth};
    for (std::size_t i = 0; i < pixels; ++i)
      copy.pixels[i] = {image.pixels[4 * i], image.pixels[4 * i + 1], image.pixels[4 * i + 2], image.pixels[4 * i + 3]};
    saveImage(file.string(), copy, parseScene(scene));
  });
}

std::string loadScene(const std::filesystem::path& file) {
  return translated([&] { return freevoxels::loadScene(file).dump(2, ' ', false, Json::error_handler_t::replace); });
}

void saveScene(const std::filesystem::path& file, std::string_view scene) {
  translated([&] { freevoxels::saveScene(file, parseScene(scene)); });
}

void bake(const std::filesystem::path& volume, const std::filesystem::path& file, std::string_view scene, const Progress& progress) {
  translated([&] { bakeFile(volume.string(), file.string(), parseScene(scene), {}, progress); });
}

void bake(const Volume& volume, const std::filesystem::path& file, std::string_view scene, const Progress& progress) {
  translated([&] { bakeShared(*volume.state_->volume, file.string(), parseScene(scene), progress); });
}

std::string info(const std::filesystem::path& volume, std::string_view scene) {
  return translated([&] { return infoOf(volume.string(), parseScene(scene)).dump(2, ' ', false, Json::error_handler_t::replace); });
}

std::string devices() {
  return translated([&] { return toJson(findDevices()).dump(2, ' ', false, Json::error_handler_t::replace); });
}

void merge(const std::vector<std::string>& parts, const std::vector<std::string>& images, std::string_view scene) {
  translated([&] { mergeFiles(parts, images, parseScene(scene)); });
}

std::string version() {
  return programVersion();
}

}  // namespace freevoxels::v1
