// Marches the cubes of a frame, front to back.

#include <algorithm>
#include <cmath>
#include <future>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "engine/cube_drawing_state.h"
#include "engine/octree/volume_builder.h"
#include "engine/splatting/splat_pass.h"

namespace freevoxels {

namespace {

constexpr int kBrick = ScalarBricks::kEdge;
static_assert(CubeDrawing::kHalo % kBrick == 0);

/// Positions on rays are counted from a place of their own in each region of this edge, in voxels, where the volume has an edge of more
/// than kLongestRegion: from far away, single precision would not tell neighbouring positions apart.
constexpr int kRegionEdge = 1 << 10, kLongestRegion = 1 << 13;

/// The region of a cube, with the voxels around it that rays read.
VoxelRange regionOf(const VoxelRange& cube, glm::ivec3 dimensions) {
  if (std::max({dimensions.x, dimensions.y, dimensions.z}) <= kLongestRegion) return {glm::ivec3(0), dimensions};
  const glm::ivec3 first = cube.first / kRegionEdge * kRegionEdge;
  constexpr int kBeyond = PieceTree::kLongestEdge + CubeDrawing::kHalo;
  return {glm::max(first - CubeDrawing::kHalo, 0), first + glm::min(dimensions - first, kRegionEdge + kBeyond)};
}

/// The part of a level in a region, as a volume of its own.
DeviceVolume partOf(const CubeLevel& level, const VoxelRange& region, const Classification& classification) {
  Volume outline = level.outline();
  outline.dimensions = region.extent();
  outline.indexToWorld = glm::translate(outline.indexToWorld, glm::dvec3(region.first));
  return outlineOnDevice(outline, classification);
}

/// Whether a frame reads slices of the cube.
bool isRead(const shader::GatherFrame& frame, const VoxelRange& cube) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!someRayHasAxis(frame, axis)) continue;
    for (const auto& ofSign : frame.axes[axis].slices)
      if (ofSign[0].x < cube.end[axis] && ofSign[0].y > cube.first[axis]) return true;
  }
  return false;
}

/// Whether a ray may meet something between the voxels of a cube, of which `read` has those in `box`. It interpolates voxels up to one
/// beyond the cube, and classifies those by their neighbours.
bool mayShow(const CubeLevel& level, const Volume& read, const VoxelRange& box, const VoxelRange& cube,
             const Classification& classification) {
  constexpr int kReach = 2;
  const glm::ivec3 low = glm::max(cube.first - kReach, box.first) - box.first, high = glm::min(cube.end + kReach, box.end) - box.first;
  Volume near = level.outline();
  near.dimensions = high - low;
  near.scalars = read.scalars.cropped(low, high);
  if (near.temperature && read.temperature) near.temperature->values = read.temperature->values.cropped(low, high);
  const Cells met = metCells(near, classification, 1 << shader::kSkipLevels);
  return std::ranges::any_of(met.values, [](std::uint8_t isMet) { return isMet != 0; });
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
  std::vector<std::uint16_t> codes(std::size_t(inBox.bricks().count()) * shader::kGatherBrickBlocks, 0);
  const glm::ivec3 size = inBox.bricks().cells(0);
  std::size_t cell = 0;
  for (glm::ivec3 brick(0); brick.z < size.z; ++brick.z)
    for (brick.y = 0; brick.y < size.y; ++brick.y)
      for (brick.x = 0; brick.x < size.x; ++brick.x, ++cell)
        if (const std::uint32_t number = inBox.bricks().numbers()[cell]; number != 0)
          light.read(firstBrick + brick,
                     std::span(codes).subspan(std::size_t(number) * shader::kGatherBrickBlocks, shader::kGatherBrickBlocks));
  return codes;
}

}  // namespace

/// The lattice and the levels of a frame, as if all of the volume were in memory.
shader::GatherFrame CubeDrawing::State::latticeOf(const Camera& camera, const FrameSettings& settings) {
  const CubeLevel& base = levelAt(0);
  FrameConstants constants = makeFrameConstants(device, base.onDevice, table, camera, settings);
  const int most = source->levels() - 1;
  constants.detail.coarsest = std::min(constants.detail.coarsest, most);
  constants.detail.finest = std::min(constants.detail.finest, most);
  return makeGatherFrame(base.onDevice, camera, settings, constants.detail, constants.endTransmittance);
}

/// The frame of a region of a level whose blocks take the place of voxels.
shader::GatherFrame CubeDrawing::State::frameOf(const Frame& frame, const CubeLevel& cubeLevel, int level, const VoxelRange& region) const {
  const bool isWhole = region.extent() == cubeLevel.outline().dimensions;
  const DeviceVolume part = isWhole ? DeviceVolume() : partOf(cubeLevel, region, frame.classification);
  shader::GatherFrame result =
      makeGatherFrame(isWhole ? cubeLevel.onDevice : part, frame.camera, frame.settings, {}, double(frame.lattice.endTransmittance));
  result.samples = frame.lattice.samples;
  result.firstSample = frame.lattice.firstSample;
  result.pitch = frame.lattice.pitch;
  result.mainAxis = frame.lattice.mainAxis;
  result.seenLow = frame.lattice.seenLow;
  result.seenHigh = frame.lattice.seenHigh;
  result.firstSeen = frame.lattice.firstSeen;
  result.seenExtent = frame.lattice.seenExtent;
  result.holdout = frame.lattice.holdout;
  for (int axis = 0; axis < 3; ++axis)
    for (int sign = 0; sign < 2; ++sign)
      result.axes[axis].slices[sign][0] =
          glm::clamp(frame.lattice.axes[axis].slices[sign][level] - region.first[axis], 0, region.extent()[axis]);
  return result;
}

/// In the order in which rays meet them.
std::vector<CubeDrawing::State::Cube> CubeDrawing::State::cubesOf(const Frame& frame, int level) {
  const CubeLevel& cubeLevel = levelAt(level);
  const RaySource eye = eyeSource(frame.camera, cubeLevel.outline().indexToWorld);
  const shader::GatherFrame whole = frameOf(frame, cubeLevel, level, {glm::ivec3(0), cubeLevel.outline().dimensions});
  std::vector<Cube> cubes;
  for (const VoxelRange& voxels : cubeLevel.cubes.inOrder(eye)) {
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
    cubeLevel.prepareLights(device, frame.allLights, times, frame.progress);
  }
  // The next cube is read while one is drawn.
  const auto beginReading = [&](std::size_t i) {
    const VoxelRange box = withHalo(cubes[i].voxels, cubeLevel.outline().dimensions);
    return std::async(std::launch::async, [&cubeLevel, box] { return cubeLevel.read(box); });
  };
  std::future<Volume> reading = beginReading(0);
  VoxelRange region;
  shader::GatherFrame inRegion{};
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    if (frame.progress) frame.progress("drawing cubes", double(i) / double(cubes.size()));
    const VoxelRange here = regionOf(cubes[i].voxels, cubeLevel.outline().dimensions);
    if (here != std::exchange(region, here)) inRegion = frameOf(frame, cubeLevel, level, region);
    Volume voxels;
    {
      const StageTimer timer(times, "read cubes");
      voxels = reading.get();
    }
    if (i + 1 < cubes.size()) reading = beginReading(i + 1);
    ++cubesRead[std::size_t(level)];
    const bool isLast = isLastLevel && i + 1 == cubes.size();
    const VoxelRange box = withHalo(cubes[i].voxels, cubeLevel.outline().dimensions);
    if (isLast || mayShow(cubeLevel, voxels, box, cubes[i].voxels, frame.classification))
      drawCube(frame, cubeLevel, inRegion, region, cubes[i], voxels, isLast);
  }
}

/// Positions on rays in `inRegion` are counted from the first voxel of `region`. `volume` has the voxels of the cube and its halo.
void CubeDrawing::State::drawCube(const Frame& frame, const CubeLevel& cubeLevel, const shader::GatherFrame& inRegion,
                                  const VoxelRange& region, const Cube& cube, const Volume& volume, bool isLast) {
  const glm::ivec3 origin = region.first;
  const VoxelRange box = withHalo(cube.voxels, cubeLevel.outline().dimensions);
  const BuiltVolume built = buildVolume(device, volume, frame.classification, times, {}, BuiltLevels::Voxels);
  const SurroundingLight light{.dimensions = cubeLevel.outline().dimensions - origin,
                               .first = box.first - origin,
                               .codes = [&](int number, const GatherVolume& inBox) {
                                 return codesOf(*cubeLevel.lights[frame.firstLight + std::size_t(number)], inBox, box.first / kBrick);
                               }};
  const Cells met = metCells(volume, frame.classification, 1 << shader::kSkipLevels);
  GatherVolume inBox(device, frame.classification, built, met, times, &light);
  FrameConstants constants = makeFrameConstants(device, built.volume, table, frame.camera, frame.settings);
  constants.detail.finest = constants.detail.coarsest = 0;
  if (frame.scattered != nullptr) setScattered(constants, *frame.settings.lighting, *frame.scattered);
  const GatherVolume::Shading shading{.frame = constants,
                                      .table = nullptr,
                                      .lighting = frame.settings.lighting ? &*frame.settings.lighting : nullptr,
                                      .lights = nullptr,
                                      .scattered = frame.isFirst() ? frame.scattered : nullptr,
                                      .axes = {someRayHasAxis(inRegion, 0), someRayHasAxis(inRegion, 1), someRayHasAxis(inRegion, 2)}};
  inBox.prepare(shading);
  Commands commands(device);
  inBox.record(commands, shading);
  shader::GatherFrame gatherFrame = inRegion;
  inBox.describe(gatherFrame);  // what record() has made too
  gatherFrame.scattered.toCells *= float(1 << cube.level);
  gatherFrame.scattered.firstCell += gatherFrame.scattered.toCells * glm::vec3(origin);
  gatherFrame.levels[0].dimensions = region.extent();
  gatherFrame.cube = {.first = box.first - origin,
                      .begin = cube.voxels.first - origin,
                      .end = cube.voxels.end - origin,
                      .corner = cube.seen.first,
                      .extent = cube.seen.extent};
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

/// Marches the rows of the frame, whose sums are then in `gather`.
void CubeDrawing::State::march(Frame& frame) {
  const std::size_t levelCount = std::size_t(frame.lattice.coarsest) + 1;
  cubesRead.resize(std::max(cubesRead.size(), levelCount), 0);
  if (!gather) gather.emplace(device);
  frame.lattice.holdout = gather->holdOut(frame.settings.holdout);
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

}  // namespace freevoxels
