// The public interface. No exception type of the engine leaves it.

#include <cmath>

#include "apps/freevoxels/program.h"
#include "apps/library/include/freevoxels/freevoxels.h"
#include "apps/library/scene_renderer.h"
#include "engine/core/error.h"
#include "engine/volume/volume_of_scalars.h"

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
    const std::string text = KeywordOptions::all().marked(error.text());
    throw Error(kindOf(error.kind()), withSceneKeys(text), parametersIn(text));
  } catch (const InternalError& error) {
    throw Error(ErrorKind::Internal, fmt::format("internal error, please report it: {}", error.what()));
  }
}

Json parseScene(std::string_view text) {
  Json scene = Json::parse(text, nullptr, false);
  if (!scene.is_object()) fail(freevoxels::ErrorKind::Usage, "a scene is a JSON object, as '{{\"size\": [800, 600]}}', not '{}'", text);
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
                         latticeTransform(vector(placement.spacing), vector(placement.origin)));
}

}  // namespace

struct Volume::State {
  std::shared_ptr<const freevoxels::Volume> volume;
};

struct Renderer::State {
  SceneRenderer renderer;
};

Volume Volume::open(const std::filesystem::path& file, std::string_view scene) {
  return translated([&] { return Volume(std::make_shared<const State>(openVolume(file.string(), parseScene(scene)))); });
}

Volume Volume::copy(std::span<const float> values, std::array<int, 3> dimensions, const Placement& placement) {
  return translated([&] {
    return Volume(std::make_shared<const State>(
        std::make_shared<const freevoxels::Volume>(volumeOf(values, dimensions, placement))));
  });
}

std::array<int, 3> Volume::dimensions() const {
  const glm::ivec3 size = state_->volume->dimensions;
  return {size.x, size.y, size.z};
}

std::uint64_t Volume::activeVoxels() const {
  return state_->volume->activeVoxels;
}

std::pair<float, float> Volume::range() const {
  return {state_->volume->minimum, state_->volume->maximum};
}

std::string Volume::source() const {
  return state_->volume->source;
}

Renderer::Renderer(Volume volume, std::string_view scene)
    : state_(translated([&] {
        return std::unique_ptr<State>(new State{SceneRenderer(volume.state_->volume, parseScene(scene))});
      })) {}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::render(std::string_view scene, bool withDepth, const Progress& progress) {
  return translated([&] {
    freevoxels::Image image = state_->renderer.render(parseScene(scene), withDepth, progress);
    const float* const first = reinterpret_cast<const float*>(image.pixels.data());
    return Image{image.size.x, image.size.y, {first, first + 4 * image.pixels.size()}, std::move(image.depth)};
  });
}

std::vector<std::pair<std::string, double>> Renderer::timings() const {
  std::vector<std::pair<std::string, double>> pairs;
  for (const StageTime& time : state_->renderer.timings()) pairs.emplace_back(time.name, time.milliseconds);
  return pairs;
}

std::string Renderer::device() const {
  return state_->renderer.device();
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

std::string version() {
  return programVersion();
}

}  // namespace freevoxels::v1
