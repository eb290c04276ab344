#include "engine/streamed_renderer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/gathering/gather_pass.h"
#include "engine/octree/volume_builder.h"
#include "engine/splatting/splat_pass.h"
#include "engine/storage/baked_box.h"
#include "engine/streamed_level.h"
#include "engine/volume/emission_light.h"
#include "engine/vulkan/target_readback.h"

namespace freevoxels {

namespace {

using fvx::FvxFile;

constexpr int kEdge = StreamedRenderer::kCubeEdge, kHalo = StreamedRenderer::kCubeHalo, kBrick = ScalarBricks::kEdge;
static_assert(kHalo % kBrick == 0);

/// Whether the coarser levels of a file are those of the octree: means of extinctions, of one colour. What a mean temperature emits is
/// not the mean emission.
bool hasOctree(const Volume& volume, const Classification& classification) {
  return !classification.transferFunction && !volume.albedo && !classification.emission;
}

FrameSettings exactSettings(const FrameSettings& wanted, bool octree) {
  FrameSettings settings = wanted;
  settings.draw = Draw::Gather;
  settings.attenuation = AttenuationLookup::Exact;
  if (settings.lighting) settings.lighting->attenuation = LightAttenuation::Exact;
  if (!octree) settings.lod = 0.0f;
  return settings;
}

fvx::VoxelBox withHalo(const fvx::VoxelBox& cube, glm::ivec3 dimensions) {
  return {glm::max(cube.first - kHalo, 0), glm::min(cube.end + kHalo, dimensions)};
}

/// How far a cube is behind the eye's, in cubes: rays meet cubes in ascending order.
int behindEye(glm::ivec3 cell, const RaySource& eye) {
  int sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (eye.atInfinity)
      sum += eye.place[axis] > 0.0 ? -cell[axis] : cell[axis];
    else
      sum += std::abs(cell[axis] - int(std::floor(std::clamp(eye.place[axis] / kEdge, -1e6, 1e6))));
  }
  return sum;
}

}  // namespace

struct StreamedRenderer::State {
  const Device& device;
  std::shared_ptr<const FvxFile> file;
  int level;
  Classification classification;
  TableSettings table;
  std::shared_ptr<const EmissionLight> emissionLight;  ///< null until a frame is lit
  std::map<int, StreamedLevel> levels;                 ///< by level above `level`
  std::optional<GatherPass> gather;
  TargetPool targetPool;
  TargetReadback colorReadback, distanceReadback;
  std::vector<StageTime> times;
  std::vector<std::size_t> cubesRead;

  /// An image with the light of some of the lights.
  struct Frame {
    const Camera& camera;
    const FrameSettings& settings;
    const Classification& classification;
    std::span<const Light> allLights;
    std::size_t firstLight;  ///< of those of `settings` among all lights
    const Progress& progress;
    shader::GatherFrame lattice;  ///< of the whole volume
  };

  void prepareEmissionLight(bool lit, const Progress& progress);
  StreamedLevel& levelAt(int above) { return levels.try_emplace(above, file, level + above, classification).first->second; }
  Image draw(const Camera& camera, const FrameSettings& settings, std::span<const Light> allLights, std::size_t firstLight,
             const Progress& progress);
  shader::GatherFrame latticeOf(const Camera& camera, const FrameSettings& settings);
  shader::GatherFrame frameOf(const Frame& frame, const StreamedLevel& level, int above) const;
  /// What is drawn at a time.
  struct Cube {
    int above = 0;
    fvx::VoxelBox voxels;
    SampleRectangle seen;
  };
  std::vector<Cube> cubesOf(const Frame& frame, int above);
  void drawLevel(const Frame& frame, int above, std::span<const Cube> cubes, bool isLastLevel);
  void drawCube(const Frame& frame, const StreamedLevel& level, const shader::GatherFrame& whole, const Cube& cube, bool isLast);
  Image resolve(const Frame& frame);
};

/// Where the volume is lit, its emission lights it, too.
void StreamedRenderer::State::prepareEmissionLight(bool lit, const Progress& progress) {
  if (!classification.emission || lit == (classification.emissionLight != nullptr)) return;
  if (lit && !emissionLight) {
    const StageTimer timer(times, "light of emission");
    const StreamedLevel& base = levelAt(0);
    const glm::ivec3 dimensions = base.outline.dimensions;
    EmissionCells cells(dimensions, base.outline.indexToWorld);
    const bool shines = brightestLight(classification, base.outline) > 0.0;
    for (std::size_t i = 0; shines && i < base.cubes.size(); ++i) {
      if (progress) progress("reading emission", double(i) / double(base.cubes.size()));
      const fvx::VoxelBox cube = cubeVoxels(base.cubes[i], dimensions);
      cells.add(readBakedBox(*file, level, cube), cube.first, classification);
    }
    emissionLight = std::make_shared<const EmissionLight>(cells);
  }
  classification.emissionLight = lit ? emissionLight : nullptr;
  levels.clear();  // which keep the classification
}

/// The lattice and the levels of a frame, as if all of the volume were in memory.
shader::GatherFrame StreamedRenderer::State::latticeOf(const Camera& camera, const FrameSettings& settings) {
  const StreamedLevel& base = levelAt(0);
  FrameConstants constants = makeFrameConstants(device, base.onDevice, table, camera, settings);
  const int most = file->levels() - 1 - level;
  constants.detail.coarsest = std::min(constants.detail.coarsest, most);
  constants.detail.finest = std::min(constants.detail.finest, most);
  return makeGatherFrame(base.onDevice, camera, settings, constants.detail, constants.hiddenTransmittance);
}

/// The frame of a level whose blocks take the place of voxels.
shader::GatherFrame StreamedRenderer::State::frameOf(const Frame& frame, const StreamedLevel& streamed, int above) const {
  shader::GatherFrame result = makeGatherFrame(streamed.onDevice, frame.camera, frame.settings, {}, double(frame.lattice.endTransmittance));
  result.samples = frame.lattice.samples;
  result.firstSample = frame.lattice.firstSample;
  result.pitch = frame.lattice.pitch;
  result.mainAxis = frame.lattice.mainAxis;
  result.seenLow = frame.lattice.seenLow;
  result.seenHigh = frame.lattice.seenHigh;
  result.firstSeen = frame.lattice.firstSeen;
  result.seenExtent = frame.lattice.seenExtent;
  for (int axis = 0; axis < 3; ++axis)
    for (int sign = 0; sign < 2; ++sign) result.axes[axis].slices[sign][0] = frame.lattice.axes[axis].slices[sign][above];
  return result;
}

namespace {

/// Whether a frame reads slices of the cube.
bool isRead(const shader::GatherFrame& frame, const fvx::VoxelBox& cube) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!someRayHasAxis(frame, axis)) continue;
    for (const auto& ofSign : frame.axes[axis].slices)
      if (ofSign[0].x < cube.end[axis] && ofSign[0].y > cube.first[axis]) return true;
  }
  return false;
}

/// The codes of a light in the order of a box's bricks.
std::vector<std::uint16_t> codesOf(const SweptLight& light, const GatherVolume& inBox, glm::ivec3 firstBrick) {
  std::vector<std::uint16_t> codes(std::size_t(inBox.brickCount()) * shader::kGatherBrickBlocks, 0);
  const glm::ivec3 size = inBox.cells().bricks.front();
  std::size_t cell = 0;
  for (glm::ivec3 brick(0); brick.z < size.z; ++brick.z)
    for (brick.y = 0; brick.y < size.y; ++brick.y)
      for (brick.x = 0; brick.x < size.x; ++brick.x, ++cell)
        if (const std::uint32_t number = inBox.cells().numbers[cell]; number != 0)
          light.read(firstBrick + brick, std::span(codes).subspan(std::size_t(number) * shader::kGatherBrickBlocks, shader::kGatherBrickBlocks));
  return codes;
}

}  // namespace

/// In the order in which rays meet them.
std::vector<StreamedRenderer::State::Cube> StreamedRenderer::State::cubesOf(const Frame& frame, int above) {
  const StreamedLevel& streamed = levelAt(above);
  const RaySource eye = eyeSource(frame.camera, streamed.outline.indexToWorld);
  const shader::GatherFrame whole = frameOf(frame, streamed, above);
  std::vector<glm::ivec3> cells = streamed.cubes;
  std::ranges::stable_sort(cells, {}, [&](glm::ivec3 cell) { return behindEye(cell, eye); });
  std::vector<Cube> cubes;
  for (const glm::ivec3 cell : cells) {
    const fvx::VoxelBox voxels = cubeVoxels(cell, streamed.outline.dimensions);
    if (!isRead(whole, voxels)) continue;
    if (const auto seen = samplesThatSee(streamed.onDevice, frame.camera, whole, voxels.first, voxels.end))
      cubes.push_back({.above = above, .voxels = voxels, .seen = *seen});
  }
  return cubes;
}

void StreamedRenderer::State::drawLevel(const Frame& frame, int above, std::span<const Cube> cubes, bool isLastLevel) {
  if (cubes.empty()) return;
  StreamedLevel& streamed = levelAt(above);
  if (frame.settings.lighting) {
    const RaySource eye = eyeSource(frame.camera, streamed.outline.indexToWorld);
    streamed.prepareLights(device, frame.allLights, times, frame.progress);
    if (frame.settings.lighting->hasAmbient()) streamed.prepareAmbient(device, *frame.settings.lighting, eye, times, frame.progress);
  }
  const shader::GatherFrame whole = frameOf(frame, streamed, above);
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    if (frame.progress) frame.progress("drawing cubes", double(i) / double(cubes.size()));
    drawCube(frame, streamed, whole, cubes[i], isLastLevel && i + 1 == cubes.size());
    ++cubesRead[std::size_t(above)];
  }
}

void StreamedRenderer::State::drawCube(const Frame& frame, const StreamedLevel& streamed, const shader::GatherFrame& whole, const Cube& cube,
                                       bool isLast) {
  const fvx::VoxelBox box = withHalo(cube.voxels, streamed.outline.dimensions);
  Volume volume;
  {
    const StageTimer timer(times, "read cubes");
    volume = readBakedBox(*file, streamed.baked.level, box);
  }
  const BuiltVolume built = buildVolume(device, volume, frame.classification, times, {}, BuiltLevels::Voxels);
  const SurroundingLight light{.dimensions = streamed.outline.dimensions,
                               .first = box.first,
                               .ambient = streamed.ambient ? &*streamed.ambient : nullptr,
                               .codes = [&](int number, const GatherVolume& inBox) {
                                 return codesOf(*streamed.lights[frame.firstLight + std::size_t(number)], inBox, box.first / kBrick);
                               }};
  GatherVolume inBox(device, volume, frame.classification, built, times, &light);
  FrameConstants constants = makeFrameConstants(device, built.volume, table, frame.camera, frame.settings);
  constants.detail.finest = constants.detail.coarsest = 0;
  const GatherVolume::Shading shading{.frame = constants,
                                      .table = nullptr,
                                      .lighting = frame.settings.lighting ? &*frame.settings.lighting : nullptr,
                                      .lights = nullptr,
                                      .axes = {someRayHasAxis(whole, 0), someRayHasAxis(whole, 1), someRayHasAxis(whole, 2)}};
  inBox.prepare(shading, times);
  Commands commands(device);
  inBox.record(commands, shading);
  shader::GatherFrame gatherFrame = whole;
  inBox.describe(gatherFrame);  // what record() has made too
  gatherFrame.levels[0].dimensions = streamed.outline.dimensions;
  gatherFrame.region = {.first = box.first,
                        .begin = cube.voxels.first,
                        .end = cube.voxels.end,
                        .corner = cube.seen.first,
                        .extent = cube.seen.extent};
  const auto march = [&](Commands& recording) {
    gather->recordRegion(recording, inBox, gatherFrame);
    recording.submitAndWait(frame.progress);
    addTimes(times, recording.times());
  };
  march(commands);
  if (!isLast) return;
  // Completes the sums of all samples, with a cube that holds nothing.
  gatherFrame.region.end = gatherFrame.region.begin;
  gatherFrame.region.corner = gatherFrame.firstSeen;
  gatherFrame.region.extent = gatherFrame.seenExtent;
  gatherFrame.region.isLast = 1;
  Commands completing(device);
  march(completing);
}

Image StreamedRenderer::State::resolve(const Frame& frame) {
  const std::shared_ptr<const FrameTargets> targets = targetPool.take(device, frame.settings, TargetKind::Image);
  Commands commands(device);
  gather->recordImage(commands, frame.lattice, classification.isPost(levelAt(0).outline), *targets);
  commands.beginPass("read back");
  colorReadback.record(device, commands, targets->colorEnergy);
  if (frame.settings.depth) distanceReadback.record(device, commands, targets->distance);
  commands.submitAndWait(frame.progress);
  addTimes(times, commands.times());
  const StageTimer timer(times, "copy to host");
  return {.size = frame.settings.size,
          .pixels = colorReadback.read<glm::vec4>(),
          .depth = frame.settings.depth ? distanceReadback.read<float>() : std::vector<float>()};
}

Image StreamedRenderer::State::draw(const Camera& camera, const FrameSettings& settings, std::span<const Light> allLights,
                                    std::size_t firstLight, const Progress& progress) {
  // Emission is drawn with the first of the lights. Without it the voxels would be classified after interpolation, if the order is Post.
  Classification dark = classification;
  dark.emission.reset();
  dark.emissionLight = nullptr;
  if (classification.emission) dark.order = ClassificationOrder::Pre;
  const Frame frame{.camera = camera,
                    .settings = settings,
                    .classification = firstLight == 0 ? classification : dark,
                    .allLights = allLights,
                    .firstLight = firstLight,
                    .progress = progress,
                    .lattice = latticeOf(camera, settings)};
  const std::size_t levelCount = std::size_t(frame.lattice.coarsest) + 1;
  cubesRead.resize(std::max(cubesRead.size(), levelCount), 0);
  if (!gather) gather.emplace(device);
  {
    Commands commands(device);
    gather->recordClear(commands, frame.lattice);
    commands.submitAndWait();
  }
  std::vector<std::vector<Cube>> levelCubes(levelCount);
  std::size_t last = 0;
  for (int above = frame.lattice.finest; above <= frame.lattice.coarsest; ++above) {
    levelCubes[std::size_t(above)] = cubesOf(frame, above);
    if (!levelCubes[std::size_t(above)].empty()) last = std::size_t(above);
  }
  for (std::size_t above = 0; above < levelCubes.size(); ++above) drawLevel(frame, int(above), levelCubes[above], above == last);
  return resolve(frame);
}

std::optional<std::string> StreamedRenderer::whyNot(const FvxFile& file, const FrameSettings& settings) {
  if (!drawsByGathering(settings)) return "splats are drawn of the whole volume";
  if (!settings.lighting) return {};
  const Lighting& lighting = *settings.lighting;
  if (lightAttenuationFor(settings) == LightAttenuation::Table) return "shadows from the table need the whole volume";
  if (lighting.hasAmbient() && ambientCellEdge(file.description().volume.dimensions, lighting.phaseG != 0.0) > kEdge)
    return "the volume is too large for the cells of ambient light";
  return {};
}

StreamedRenderer::StreamedRenderer(const Device& device, std::shared_ptr<const FvxFile> file, int level, const Classification& classification,
                                   const TableSettings& table)
    : state_(new State{.device = device, .file = std::move(file), .level = level, .classification = classification, .table = table}) {}

StreamedRenderer::~StreamedRenderer() = default;

Image StreamedRenderer::render(const Camera& camera, const FrameSettings& wanted, const Progress& progress) {
  State& state = *state_;
  checkCamera(camera);
  checkFrameFits(state.device, wanted);
  state.times.clear();
  state.cubesRead.clear();
  state.prepareEmissionLight(wanted.lighting.has_value(), progress);
  FrameSettings settings = exactSettings(wanted, hasOctree(state.levelAt(0).outline, state.classification));
  const std::vector<Light> lights = settings.lighting ? settings.lighting->lights : std::vector<Light>();
  const std::span<const Light> all(lights);
  constexpr std::size_t kAtOnce = shader::kMaxSampleLights;
  if (all.size() > kAtOnce) settings.lighting->lights.assign(all.begin(), all.begin() + kAtOnce);
  Image image = state.draw(camera, settings, all, 0, progress);
  if (all.size() <= kAtOnce) return image;
  // Light adds up. Alpha does not depend on the lights.
  settings.depth = false;
  settings.lighting->ambient = glm::dvec3(0.0);
  settings.lighting->environment = nullptr;
  for (std::size_t first = kAtOnce; first < all.size(); first += kAtOnce) {
    const std::span<const Light> some = all.subspan(first, std::min(kAtOnce, all.size() - first));
    settings.lighting->lights.assign(some.begin(), some.end());
    const Image more = state.draw(camera, settings, all, first, progress);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += glm::vec4(glm::vec3(more.pixels[i]), 0.0f);
  }
  return image;
}

std::vector<StageTime> StreamedRenderer::timings() const { return state_->times; }

const std::vector<std::size_t>& StreamedRenderer::cubesRead() const { return state_->cubesRead; }

VolumeMemory StreamedRenderer::memory() const {
  const DeviceVolume& whole = state_->levelAt(0).onDevice;
  const HierarchyLayout hierarchy(glm::min(whole.layout.dimensions, kCubeEdge + 2 * kCubeHalo));
  std::vector<std::uint64_t> blocks(hierarchy.levels.size(), 0);
  blocks.front() = hierarchy.levels.front().voxels();
  VolumeMemory memory = volumeMemory(hierarchy, blocks, state_->table.directions, storedKinds(whole), sweepStyle(state_->device));
  memory.table = memory.sweep = memory.splats = 0;
  return memory;
}

}  // namespace freevoxels
