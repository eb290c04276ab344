// Contexts, volumes, frames and renderers. No exception type of the engine leaves the interface.

#include <fmt/ranges.h>
#include <volk.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

#include "apps/common/keyword_options.h"
#include "apps/library/include/freevoxels/vulkan.h"
#include "apps/library/translation.h"
#include "engine/core/json_file.h"
#include "engine/volume/volume_of_scalars.h"
#include "engine/vulkan/device_requirements.h"
#include "engine/vulkan/queue.h"

namespace freevoxels::v1 {

namespace {

/// The values of a box, of which those of further channels follow each other.
ScalarBricks bricksOf(std::span<const float> values, glm::ivec3 size) {
  return ScalarBricks::make(size, [&](glm::ivec3 voxel) {
    const std::size_t row = std::size_t(voxel.y) + std::size_t(size.y) * std::size_t(voxel.z);
    const float value = values[std::size_t(voxel.x) + std::size_t(size.x) * row];
    return std::isnan(value) ? kInactiveVoxel : value;
  });
}

freevoxels::Volume volumeOf(std::span<const float> values, std::array<int, 3> dimensions, const Placement& placement,
                            std::string_view scene) {
  const auto& [x, y, z] = dimensions;
  const KeywordOptions options({parseJson("scene", "of the values", scene)}, {"classification"});
  const std::optional<Labels>& labels = options.scene.classification.labels;
  const std::vector<ChannelStyle>& channels = options.scene.classification.channels;
  const std::size_t count = values.size();
  // Divided rather than multiplied, as the product of three edges may exceed 64 bits.
  const bool fits = std::min({x, y, z}) >= 1 && std::size_t(x) <= count && std::size_t(y) <= count / std::size_t(x) &&
                    std::size_t(z) <= count / std::size_t(x) / std::size_t(y);
  const std::size_t voxels = fits ? std::size_t(x) * std::size_t(y) * std::size_t(z) : 0;
  if (!fits || count % voxels != 0 || (count != voxels && channels.empty()))
    fail(freevoxels::ErrorKind::Input, "{} values are not a box of {} x {} x {} voxels", values.size(), x, y, z);
  const auto vector = [](const std::array<double, 3>& v) { return glm::dvec3(v[0], v[1], v[2]); };
  const glm::ivec3 size(x, y, z);
  const glm::dmat4 transform = latticeTransform(vector(placement.spacing), vector(placement.origin));
  if (channels.empty())
    return volumeOfScalars(bricksOf(values, size), transform, std::nullopt, "the array", labels && !labels->isNone() ? &*labels : nullptr);
  std::vector<ScalarBricks> ofChannels;
  for (const ChannelStyle& channel : channels)
    ofChannels.push_back(bricksOf(values.subspan(channelNumber(channel, count / voxels) * voxels, voxels), size));
  return volumeOfChannels(std::move(ofChannels), transform, channels);
}

DeviceOptions limited(int mebibytes) {
  DeviceOptions options;
  if (mebibytes < 0) fail(freevoxels::ErrorKind::Usage, "a limit of {} MiB on device memory is below 0: 0 is no limit", mebibytes);
  if (mebibytes > 0) options.memoryLimit = mebibytes;
  return options;
}

std::optional<double> budgetOf(const FrameOptions& options) {
  return options.budget == 0.0 ? std::nullopt : std::optional(options.budget);
}

/// A turn of which frames are drawn.
struct DrawnTurn {
  std::string scene;
  int firstFrame = 0;  ///< that was drawn
  std::unique_ptr<const KeywordOptions> options;
  TurnViews views;
};

/// The turn of the frame that was drawn last. Any thread may call the member function.
class LastTurn {
 public:
  /// The turn of this frame: the last one, unless that is another, or the frame began it and so begins it again.
  std::shared_ptr<DrawnTurn> get(const SceneRenderer& renderer, int frame, int frames, std::string_view scene) {
    const std::lock_guard lock(mutex_);
    if (!turn_ || turn_->scene != scene || turn_->views.frames != frames || turn_->firstFrame == frame)
      turn_ = std::make_shared<DrawnTurn>(DrawnTurn{std::string(scene), frame, renderer.read(parseScene(scene)), {.frames = frames}});
    return turn_;
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<DrawnTurn> turn_;
};

}  // namespace

struct Frame::State {
  std::shared_ptr<SubmittedFrame> frame;
};

struct Renderer::State {
  SceneRenderer renderer;
  LastTurn turn;
  FrameQueue queue;  // last, as it draws with `renderer`
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
    return Context(
        std::make_shared<Context::State>(Context::State{std::make_shared<DeviceContext>(adopted.instance, device, limited(memoryLimit))}));
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
  return translated(
      [&] { return Volume(std::make_shared<const State>(openVolume(file.string(), parseScene(scene), context.state_->context))); });
}

Volume Volume::open(const std::filesystem::path& file, std::string_view scene) {
  return translated([&] { return Volume(std::make_shared<const State>(openVolume(file.string(), parseScene(scene)))); });
}

Volume Volume::copy(std::span<const float> values, std::array<int, 3> dimensions, const Placement& placement, std::string_view scene) {
  return translated([&] {
    return Volume(std::make_shared<const State>(std::make_shared<const SharedVolume>(volumeOf(values, dimensions, placement, scene))));
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
        return std::unique_ptr<State>(new State{SceneRenderer(volume.state_->volume, parseScene(scene), context.state_->context), {}, {}});
      })) {}

Renderer::Renderer(Volume volume, std::string_view scene)
    : state_(translated([&] {
        return std::unique_ptr<State>(new State{SceneRenderer(volume.state_->volume, parseScene(scene)), {}, {}});
      })) {}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::render(std::string_view scene, const FrameOptions& options) {
  return translated([&] {
    SceneRenderer& renderer = state_->renderer;
    return imageOf(renderer.render(*renderer.read(parseScene(scene), holdoutOf(options.holdout), budgetOf(options)),
                                   {.depth = options.depth}, options.progress));
  });
}

Image Renderer::renderTurn(int frame, int frames, std::string_view scene, const FrameOptions& options) {
  return translated([&] {
    if (frames < 1 || frames > kMaximumFrames || frame < 0 || frame >= frames)
      fail(freevoxels::ErrorKind::Usage, "frame {} is not one of {} {}, which are numbered from 0: there are 1 to {}", frame, frames,
           Parameter("frames"), kMaximumFrames);
    SceneRenderer& renderer = state_->renderer;
    const std::shared_ptr<DrawnTurn> turn = state_->turn.get(renderer, frame, frames, scene);
    return imageOf(renderer.renderTurn(withFrame(*turn->options, holdoutOf(options.holdout), budgetOf(options)), {frame, turn->views},
                                       {.depth = options.depth}, options.progress));
  });
}

std::string Renderer::camera() const {
  return state_->renderer.camera().dump();
}

Frame Renderer::submit(std::string_view scene, const FrameOptions& options) {
  return translated([&] {
    SceneRenderer& renderer = state_->renderer;
    std::shared_ptr<const KeywordOptions> read = renderer.read(parseScene(scene), holdoutOf(options.holdout), budgetOf(options));
    auto frame = std::make_shared<SubmittedFrame>(
        renderer.context(),
        [&renderer, read = std::move(read), depth = options.depth](const freevoxels::Progress& report) {
          return renderer.renderOnDevice(*read, depth, report);
        },
        options.progress);
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

}  // namespace freevoxels::v1
