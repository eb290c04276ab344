#include "engine/cube_drawing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/gathering/gather_pass.h"
#include "engine/gathering/gather_rows.h"
#include "engine/image/display_pass.h"
#include "engine/octree/volume_builder.h"
#include "engine/splatting/accumulate_pass.h"
#include "engine/splatting/splat_pass.h"
#include "engine/volume/emission_light.h"

namespace freevoxels {

namespace {

constexpr int kEdge = kCubeEdge, kHalo = CubeDrawing::kHalo, kBrick = ScalarBricks::kEdge;
static_assert(kHalo % kBrick == 0);

/// Whether the coarser levels of a source are those of the octree: means of extinctions, of one colour. What a mean temperature emits is
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

VoxelRange withHalo(const VoxelRange& cube, glm::ivec3 dimensions) {
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

struct CubeDrawing::State {
  const Device& device;
  std::shared_ptr<const VolumeSource> source;
  Classification classification;
  TableSettings table;
  std::shared_ptr<const EmissionLight> emissionLight;  ///< null until a frame is lit
  std::map<int, CubeLevel> levels = {};
  std::optional<GatherPass> gather = {};
  Classification dark = {};  ///< `classification` without emission, which is drawn with the first group of lights
  TargetPool targetPool = {};
  std::vector<StageTime> times = {};
  std::vector<std::size_t> cubesRead = {};

  /// An image with the light of some of the lights.
  struct Frame {
    const Camera& camera;
    const FrameSettings& settings;
    const Classification& classification;
    std::span<const Light> allLights;
    std::size_t firstLight;  ///< of those of `settings` among all lights
    const Progress& progress;
    shader::GatherFrame lattice;  ///< of the whole volume
    glm::ivec2 rows{0};           ///< first and end of the rows of samples that are drawn
  };

  void prepareEmissionLight(bool lit, const Progress& progress);
  CubeLevel& levelAt(int level) { return levels.try_emplace(level, source, level, classification).first->second; }
  /// An image is the sum of those of groups of lights.
  struct LightGroups {
    std::vector<Light> all;
    std::vector<FrameSettings> settings;  ///< of each group
  };
  LightGroups groupLights(const FrameSettings& wanted) const;
  Frame frameOfGroup(const Camera& camera, const LightGroups& groups, std::size_t group, const Progress& progress);
  void begin(const Camera& camera, const FrameSettings& wanted, const Progress& progress);
  FixedSums emptySums(const Frame& frame, const FrameSettings& wanted);
  std::uint64_t mostBricks();
  std::uint64_t leastBytes(const Camera& camera, const FrameSettings& wanted);
  Error withNeed(const Error& error, const Camera& camera, const FrameSettings& wanted);
  void march(const Frame& frame);
  shader::GatherFrame latticeOf(const Camera& camera, const FrameSettings& settings);
  shader::GatherFrame frameOf(const Frame& frame, const CubeLevel& cubeLevel, int level) const;
  /// What is drawn at a time.
  struct Cube {
    int level = 0;
    VoxelRange voxels;
    SampleRectangle seen;
  };
  std::vector<Cube> cubesOf(const Frame& frame, int level);
  void drawLevel(const Frame& frame, int level, std::span<const Cube> cubes, bool isLastLevel);
  void drawCube(const Frame& frame, const CubeLevel& cubeLevel, const shader::GatherFrame& whole, const Cube& cube, bool isLast);
  void resolve(const Frame& frame, const FrameTargets& targets);
};

/// Where the volume is lit, its emission lights it, too.
void CubeDrawing::State::prepareEmissionLight(bool lit, const Progress& progress) {
  if (!classification.emission || lit == (classification.emissionLight != nullptr)) return;
  if (lit && !emissionLight) {
    const StageTimer timer(times, "light of emission");
    const CubeLevel& base = levelAt(0);
    const glm::ivec3 dimensions = base.outline().dimensions;
    EmissionCells cells(dimensions, base.outline().indexToWorld);
    const bool shines = brightestLight(classification, base.outline()) > 0.0;
    for (std::size_t i = 0; shines && i < base.cubes.size(); ++i) {
      if (progress) progress("reading emission", double(i) / double(base.cubes.size()));
      const VoxelRange cube = cubeVoxels(base.cubes[i], dimensions);
      cells.add(base.read(cube), cube.first, classification);
    }
    emissionLight = std::make_shared<const EmissionLight>(cells);
  }
  classification.emissionLight = lit ? emissionLight : nullptr;
  levels.clear();  // which keep the classification
}

/// The lattice and the levels of a frame, as if all of the volume were in memory.
shader::GatherFrame CubeDrawing::State::latticeOf(const Camera& camera, const FrameSettings& settings) {
  const CubeLevel& base = levelAt(0);
  FrameConstants constants = makeFrameConstants(device, base.onDevice, table, camera, settings);
  const int most = source->levels() - 1;
  constants.detail.coarsest = std::min(constants.detail.coarsest, most);
  constants.detail.finest = std::min(constants.detail.finest, most);
  return makeGatherFrame(base.onDevice, camera, settings, constants.detail, constants.hiddenTransmittance);
}

/// The frame of a level whose blocks take the place of voxels.
shader::GatherFrame CubeDrawing::State::frameOf(const Frame& frame, const CubeLevel& cubeLevel, int level) const {
  shader::GatherFrame result =
      makeGatherFrame(cubeLevel.onDevice, frame.camera, frame.settings, {}, double(frame.lattice.endTransmittance));
  result.samples = frame.lattice.samples;
  result.firstSample = frame.lattice.firstSample;
  result.pitch = frame.lattice.pitch;
  result.mainAxis = frame.lattice.mainAxis;
  result.seenLow = frame.lattice.seenLow;
  result.seenHigh = frame.lattice.seenHigh;
  result.firstSeen = frame.lattice.firstSeen;
  result.seenExtent = frame.lattice.seenExtent;
  for (int axis = 0; axis < 3; ++axis)
    for (int sign = 0; sign < 2; ++sign) result.axes[axis].slices[sign][0] = frame.lattice.axes[axis].slices[sign][level];
  return result;
}

namespace {

/// Whether a frame reads slices of the cube.
bool isRead(const shader::GatherFrame& frame, const VoxelRange& cube) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!someRayHasAxis(frame, axis)) continue;
    for (const auto& ofSign : frame.axes[axis].slices)
      if (ofSign[0].x < cube.end[axis] && ofSign[0].y > cube.first[axis]) return true;
  }
  return false;
}

/// The part of a rectangle in some rows.
SampleRectangle inRows(const SampleRectangle& rectangle, glm::ivec2 rows) {
  SampleRectangle result = rectangle;
  result.first.y = std::max(rectangle.first.y, rows.x);
  result.extent.y = std::max(std::min(rectangle.first.y + rectangle.extent.y, rows.y) - result.first.y, 0);
  return result;
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
          light.read(firstBrick + brick,
                     std::span(codes).subspan(std::size_t(number) * shader::kGatherBrickBlocks, shader::kGatherBrickBlocks));
  return codes;
}

}  // namespace

/// In the order in which rays meet them.
std::vector<CubeDrawing::State::Cube> CubeDrawing::State::cubesOf(const Frame& frame, int level) {
  const CubeLevel& cubeLevel = levelAt(level);
  const RaySource eye = eyeSource(frame.camera, cubeLevel.outline().indexToWorld);
  const shader::GatherFrame whole = frameOf(frame, cubeLevel, level);
  std::vector<glm::ivec3> cells = cubeLevel.cubes;
  std::ranges::stable_sort(cells, {}, [&](glm::ivec3 cell) { return behindEye(cell, eye); });
  std::vector<Cube> cubes;
  for (const glm::ivec3 cell : cells) {
    const VoxelRange voxels = cubeVoxels(cell, cubeLevel.outline().dimensions);
    if (!isRead(whole, voxels)) continue;
    if (const auto seen = samplesThatSee(cubeLevel.onDevice, frame.camera, whole, voxels.first, voxels.end))
      if (const SampleRectangle own = inRows(*seen, frame.rows); own.extent.y > 0)
        cubes.push_back({.level = level, .voxels = voxels, .seen = own});
  }
  return cubes;
}

void CubeDrawing::State::drawLevel(const Frame& frame, int level, std::span<const Cube> cubes, bool isLastLevel) {
  if (cubes.empty()) return;
  CubeLevel& cubeLevel = levelAt(level);
  if (frame.settings.lighting) {
    const RaySource eye = eyeSource(frame.camera, cubeLevel.outline().indexToWorld);
    cubeLevel.prepareLights(device, frame.allLights, times, frame.progress);
    if (frame.settings.lighting->hasAmbient()) cubeLevel.prepareAmbient(device, *frame.settings.lighting, eye, times, frame.progress);
  }
  const shader::GatherFrame whole = frameOf(frame, cubeLevel, level);
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    if (frame.progress) frame.progress("drawing cubes", double(i) / double(cubes.size()));
    drawCube(frame, cubeLevel, whole, cubes[i], isLastLevel && i + 1 == cubes.size());
    ++cubesRead[std::size_t(level)];
  }
}

void CubeDrawing::State::drawCube(const Frame& frame, const CubeLevel& cubeLevel, const shader::GatherFrame& whole, const Cube& cube,
                                  bool isLast) {
  const VoxelRange box = withHalo(cube.voxels, cubeLevel.outline().dimensions);
  Volume volume;
  {
    const StageTimer timer(times, "read cubes");
    volume = cubeLevel.read(box);
  }
  const BuiltVolume built = buildVolume(device, volume, frame.classification, times, {}, BuiltLevels::Voxels);
  const SurroundingLight light{.dimensions = cubeLevel.outline().dimensions,
                               .first = box.first,
                               .ambient = cubeLevel.ambient ? &*cubeLevel.ambient : nullptr,
                               .codes = [&](int number, const GatherVolume& inBox) {
                                 return codesOf(*cubeLevel.lights[frame.firstLight + std::size_t(number)], inBox, box.first / kBrick);
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
  gatherFrame.levels[0].dimensions = cubeLevel.outline().dimensions;
  gatherFrame.cube = {
      .first = box.first, .begin = cube.voxels.first, .end = cube.voxels.end, .corner = cube.seen.first, .extent = cube.seen.extent};
  const auto march = [&](Commands& recording) {
    gather->recordCube(recording, inBox, gatherFrame);
    recording.submitAndWait(frame.progress);
    addTimes(times, recording.times());
  };
  march(commands);
  if (!isLast) return;
  // Completes the sums of all samples, with a cube that holds nothing.
  gatherFrame.cube.end = gatherFrame.cube.begin;
  const SampleRectangle own = inRows({.first = gatherFrame.firstSeen, .extent = gatherFrame.seenExtent}, frame.rows);
  gatherFrame.cube.corner = own.first;
  gatherFrame.cube.extent = own.extent;
  gatherFrame.cube.isLast = 1;
  Commands completing(device);
  march(completing);
}

void CubeDrawing::State::resolve(const Frame& frame, const FrameTargets& targets) {
  Commands commands(device);
  gather->recordImage(commands, frame.lattice, classification.isPost(levelAt(0).outline()), targets);
  commands.submitAndWait(frame.progress);
  addTimes(times, commands.times());
}

/// The sums of no sample, in the form in which samples are added.
FixedSums CubeDrawing::State::emptySums(const Frame& frame, const FrameSettings& wanted) {
  const DeviceVolume& volume = levelAt(0).onDevice;
  FixedSums sums = sumsOfSamples(frame.lattice, classification.isPost(levelAt(0).outline()),
                                 sumsLayout(volume, makeFrameConstants(device, volume, table, frame.camera, frame.settings), wanted));
  sums.method += ", cube by cube";
  return sums;
}

/// The most bricks with data that a cube is read with.
std::uint64_t CubeDrawing::State::mostBricks() {
  const CubeLevel& base = levelAt(0);
  const Cells bricks = source->bricks();
  std::uint64_t most = 0;
  for (const glm::ivec3 cube : base.cubes) {
    const VoxelRange box = withHalo(cubeVoxels(cube, base.outline().dimensions), base.outline().dimensions);
    const glm::ivec3 first = box.first / kBrick, end = (box.end + kBrick - 1) / kBrick;
    std::uint64_t count = 0;
    for (glm::ivec3 brick = first; brick.z < end.z; ++brick.z)
      for (brick.y = first.y; brick.y < end.y; ++brick.y)
        for (brick.x = first.x; brick.x < end.x; ++brick.x) count += bricks.at(brick);
    most = std::max(most, count);
  }
  return most;
}

/// Bytes of device memory that a frame takes, rounded up: its images and sums, and a cube or the sweep of a light.
std::uint64_t CubeDrawing::State::leastBytes(const Camera& camera, const FrameSettings& wanted) {
  const Volume& outline = levelAt(0).outline();
  const LightGroups groups = groupLights(wanted);
  const FrameSettings& settings = groups.settings.front();
  const shader::GatherFrame lattice = latticeOf(camera, settings);
  std::uint64_t axes = 0;
  for (int axis = 0; axis < 3; ++axis) axes += someRayHasAxis(lattice, axis) ? 1 : 0;
  const std::uint64_t voxels = (mostBricks() + 1) * std::uint64_t(kBrick * kBrick * kBrick);
  const std::uint64_t slots = settings.lighting ? settings.lighting->lights.size() + (settings.lighting->hasAmbient() ? 3 : 0) : 0;
  // Of a voxel: what is built of it, and its quads, of which those of light and emission are for all axes along which rays march.
  const std::uint64_t built = 24, quads = sizeof(glm::uvec2) * (1 + slots) + (classification.emission ? 2 * sizeof(glm::uvec4) : 0);
  std::uint64_t largest = voxels * (built + slots * sizeof(std::uint16_t) + axes * quads);
  for (const Light& light : groups.all)
    largest = std::max(largest, SweptLight::leastBytes(outline.dimensions, lightSource(light, outline.indexToWorld)));
  constexpr std::uint64_t kSums = 3, kSumBytes = sizeof(glm::vec4) + sizeof(float);
  const std::uint64_t sums = kSums * kSumBytes * std::uint64_t(lattice.samples.x) * std::uint64_t(lattice.samples.y);
  const std::uint64_t bytes = 2 * targetBytes(wanted) + sums + largest;
  return bytes + bytes / 8 + (std::uint64_t(4) << 20);
}

/// `error`, or where the device's memory is limited a sentence with what the frame needs.
Error CubeDrawing::State::withNeed(const Error& error, const Camera& camera, const FrameSettings& wanted) {
  if (error.kind() != ErrorKind::OutOfMemory || device.memoryBytes() >= device.description().memoryBytes) return error;
  const std::uint64_t bytes = leastBytes(camera, wanted);
  if (bytes <= device.memoryBytes()) return error;
  const glm::ivec3 box = source->outline().dimensions;
  return Error(
      ErrorKind::OutOfMemory,
      fmt::format("a volume of {}x{}x{} voxels and an image of {}x{} pixels need at least {} MiB of device memory, piece by piece, and "
                  "{} is {} MiB: raise that, or draw a smaller image",
                  box.x, box.y, box.z, wanted.size.x, wanted.size.y, (bytes + 0xfffff) >> 20, Parameter("memory-limit"),
                  device.memoryBytes() >> 20));
}

/// Marches the rows of the frame, whose sums are then in `gather`.
void CubeDrawing::State::march(const Frame& frame) {
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
  for (int level = frame.lattice.finest; level <= frame.lattice.coarsest; ++level) {
    levelCubes[std::size_t(level)] = cubesOf(frame, level);
    if (!levelCubes[std::size_t(level)].empty()) last = std::size_t(level);
  }
  for (std::size_t level = 0; level < levelCubes.size(); ++level) drawLevel(frame, int(level), levelCubes[level], level == last);
}

/// Emission, ambient light and distances are those of the first group.
CubeDrawing::State::LightGroups CubeDrawing::State::groupLights(const FrameSettings& wanted) const {
  constexpr std::size_t kAtOnce = shader::kMaxSampleLights;
  const Volume& outline = source->outline();
  LightGroups groups{.all = wanted.lighting ? wanted.lighting->lights : std::vector<Light>(),
                     .settings = {exactSettings(wanted, hasOctree(outline, classification))}};
  if (groups.all.size() <= kAtOnce) return groups;
  groups.settings.resize((groups.all.size() + kAtOnce - 1) / kAtOnce, groups.settings.front());
  for (std::size_t group = 0; group < groups.settings.size(); ++group) {
    Lighting& lighting = groups.settings[group].lighting.value();
    const auto begin = groups.all.begin() + std::ptrdiff_t(group * kAtOnce);
    lighting.lights.assign(begin, begin + std::ptrdiff_t(std::min(kAtOnce, groups.all.size() - group * kAtOnce)));
    if (group == 0) continue;
    groups.settings[group].depth = false;
    lighting.ambient = glm::dvec3(0.0);
    lighting.environment = nullptr;
  }
  return groups;
}

CubeDrawing::State::Frame CubeDrawing::State::frameOfGroup(const Camera& camera, const LightGroups& groups, std::size_t group,
                                                           const Progress& progress) {
  const FrameSettings& settings = groups.settings[group];
  Frame frame{.camera = camera,
              .settings = settings,
              .classification = group == 0 ? classification : dark,
              .allLights = groups.all,
              .firstLight = group * shader::kMaxSampleLights,
              .progress = progress,
              .lattice = latticeOf(camera, settings)};
  frame.rows = {0, frame.lattice.samples.y};
  return frame;
}

void CubeDrawing::State::begin(const Camera& camera, const FrameSettings& wanted, const Progress& progress) {
  checkCamera(camera);
  checkFrameFits(device, wanted);
  times.clear();
  cubesRead.clear();
  prepareEmissionLight(wanted.lighting.has_value(), progress);
  dark = classification;
  dark.emission.reset();
  dark.emissionLight = nullptr;
  // Otherwise voxels without emission would be classified after interpolation.
  if (classification.emission) dark.order = ClassificationOrder::Pre;
}

std::optional<std::string> CubeDrawing::whyNot(glm::ivec3 dimensions, const FrameSettings& settings) {
  if (!drawsByGathering(settings)) return "splats are drawn of the whole volume";
  if (!settings.lighting) return {};
  const Lighting& lighting = *settings.lighting;
  if (lightAttenuationFor(settings) == LightAttenuation::Table) return "shadows from the table need the whole volume";
  if (lighting.hasAmbient() && ambientCellEdge(dimensions, lighting.phaseG != 0.0) > kEdge)
    return "the volume is too large for the cells of ambient light";
  return {};
}

CubeDrawing::CubeDrawing(const Device& device, std::shared_ptr<const VolumeSource> source, const Classification& classification,
                         const TableSettings& table)
    : state_(new State{.device = device,
                       .source = std::move(source),
                       .classification = classification,
                       .table = table,
                       .emissionLight = classification.emissionLight}) {}

CubeDrawing::~CubeDrawing() = default;

std::shared_ptr<const FrameTargets> CubeDrawing::draw(const Camera& camera, const FrameSettings& wanted, const Progress& progress) try {
  State& state = *state_;
  state.begin(camera, wanted, progress);
  const State::LightGroups groups = state.groupLights(wanted);
  const auto drawGroup = [&](std::size_t group, const FrameTargets& targets) {
    const State::Frame frame = state.frameOfGroup(camera, groups, group, progress);
    state.march(frame);
    state.resolve(frame, targets);
  };
  if (groups.settings.size() == 1) {
    std::shared_ptr<const FrameTargets> targets = state.targetPool.take(state.device, wanted, TargetKind::Image);
    drawGroup(0, *targets);
    return targets;
  }
  // Light adds up. Alpha does not depend on the lights.
  FrameTargets targets = makeTargets(state.device, wanted, TargetKind::Image);
  drawGroup(0, targets);
  Image image = downloadImage(state.device, targets);
  for (std::size_t group = 1; group < groups.settings.size(); ++group) {
    const FrameTargets more = makeTargets(state.device, groups.settings[group], TargetKind::Image);
    drawGroup(group, more);
    const std::vector<glm::vec4> pixels = downloadImage(state.device, more).pixels;
    for (std::size_t i = 0; i < pixels.size(); ++i) image.pixels[i] += glm::vec4(glm::vec3(pixels[i]), 0.0f);
  }
  targets.colorEnergy = uploadImage(state.device, image);
  return std::make_shared<const FrameTargets>(std::move(targets));
} catch (const Error& error) {
  throw state_->withNeed(error, camera, wanted);
}

FixedSums CubeDrawing::drawShares(const Camera& camera, const FrameSettings& wanted, const SharePart& part, const Progress& progress) try {
  State& state = *state_;
  state.begin(camera, wanted, progress);
  const State::LightGroups groups = state.groupLights(wanted);
  FixedSums sums;
  for (std::size_t group = 0; group < groups.settings.size(); ++group) {
    State::Frame frame = state.frameOfGroup(camera, groups, group, progress);
    frame.rows = rowsOfPart(frame.lattice, part);
    if (group == 0) sums = state.emptySums(frame, wanted);
    if (frame.rows.x == frame.rows.y) continue;
    state.march(frame);
    const StageTimer timer(state.times, "copy to host");
    addSamples(sums, state.gather->downloadGathered(), frame.rows, group > 0);
  }
  return sums;
} catch (const Error& error) {
  throw state_->withNeed(error, camera, wanted);
}

const std::vector<StageTime>& CubeDrawing::timings() const {
  return state_->times;
}

const std::vector<std::size_t>& CubeDrawing::cubesRead() const {
  return state_->cubesRead;
}

VolumeMemory CubeDrawing::memory() const {
  const DeviceVolume& whole = state_->levelAt(0).onDevice;
  const HierarchyLayout hierarchy(glm::min(whole.layout.dimensions, kEdge + 2 * kHalo));
  std::vector<std::uint64_t> blocks(hierarchy.levels.size(), 0);
  blocks.front() = hierarchy.levels.front().voxels();
  VolumeMemory memory = volumeMemory(hierarchy, blocks, state_->table.directions, storedKinds(whole), sweepStyle(state_->device));
  memory.table = memory.sweep = memory.splats = 0;
  return memory;
}

}  // namespace freevoxels
