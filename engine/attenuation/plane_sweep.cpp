#include "engine/attenuation/plane_sweep.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "embedded/light_planes.h"
#include "embedded/ray_sweep.h"
#include "engine/attenuation/island_shadows.h"
#include "engine/attenuation/islands.h"
#include "engine/attenuation/ray_sweep.h"
#include "engine/attenuation/swept_bricks.h"
#include "engine/attenuation/voxel_values.h"
#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/octree/device_volume.h"
#include "engine/octree/occupied_cells.h"
#include "engine/vulkan/commands.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

constexpr int kEdge = ScalarBricks::kEdge;
constexpr VkPipelineStageFlags2 kTransfer = VK_PIPELINE_STAGE_2_TRANSFER_BIT;
constexpr int kMaxPlanes = 8, kMinPlanes = 2;  ///< that are swept at a time

glm::ivec2 sidesOf(const FaceRays& fan, glm::ivec3 dimensions) {
  return {dimensions[(fan.axis + 1) % 3], dimensions[(fan.axis + 2) % 3]};
}

std::uint64_t slabVoxels(glm::ivec2 sides, int planes) {
  return std::uint64_t(planes + 1) * std::uint64_t(sides.x + 2) * std::uint64_t(sides.y + 2);
}

/// The pairs of planes of a slab, and the pair before them.
std::uint64_t depthBytes(const FaceRays& fan, int planes) {
  return fan.rays() * std::uint64_t(planes / 2 + 1) * sizeof(std::uint32_t);
}

std::uint64_t groupCount(const FaceRays& fan) {
  return (fan.rays() + shader::kRaySweepThreads - 1) / shader::kRaySweepThreads;
}

constexpr int kBrickFace = kEdge * kEdge;  // voxels of a plane in a brick
static_assert(shader::kLightBrickEdge == kEdge);

/// What a face of a sweep takes on the device, if the light is kept in all bricks.
std::uint64_t sweepBytes(const FaceRays& fan, glm::ivec3 dimensions, int planes) {
  const glm::ivec2 sides = sidesOf(fan, dimensions), bricks = (sides + kEdge - 1) / kEdge;
  const glm::ivec3 cells = (dimensions + OccupiedCells::kEdge - 1) / OccupiedCells::kEdge;
  return slabVoxels(sides, planes) * sizeof(float) + fan.rays() * sizeof(float) + (1 + groupCount(fan)) * sizeof(std::uint32_t) +
         depthBytes(fan, planes) +
         std::uint64_t(bricks.x) * std::uint64_t(bricks.y) *
             (std::uint64_t(kBrickFace * planes) * sizeof(std::uint16_t) + SweptBricks::kLayersOfSlab * sizeof(glm::ivec2)) +
         std::uint64_t(cells.x) * std::uint64_t(cells.y) * std::uint64_t(cells.z);
}

/// The boxes of a level through which lights are swept: the level's, or where that has more voxels than can be numbered, those of islands.
std::vector<VoxelRange> sweptBoxes(const SourceLevel& level, const SparseGrid<std::uint8_t>& around) {
  const Volume& outline = level.outline();
  if (outline.voxelCount() <= std::size_t(std::numeric_limits<std::int32_t>::max()))
    return {{.first = glm::ivec3(0), .end = outline.dimensions}};
  return islandsOf(around, outline.dimensions);
}

/// The source in the index space of a box.
RaySource fromBox(const RaySource& source, const VoxelRange& box) {
  return {.place = source.atInfinity ? source.place : source.place - glm::dvec3(box.first), .atInfinity = source.atInfinity};
}

}  // namespace

/// The sweep of one face of a box.
class SweptLight::Sweep {
 public:
  /// `withData` marks the bricks of the level that have data, and `around` those whose light is kept. With `isIsland`, there are further
  /// boxes.
  Sweep(SweptLight& light, const Device& device, const SourceLevel& level, const VoxelValues& values,
        const SparseGrid<std::uint8_t>& withData, const SparseGrid<std::uint8_t>& around, const VoxelRange& box, const FaceRays& fan,
        int fanNumber, bool isIsland)
      : light_(light),
        device_(device),
        level_(level),
        values_(values),
        box_(box),
        fan_(fan),
        kept_(around, box, fan),
        fanNumber_(fanNumber),
        isIsland_(isIsland),
        dimensions_(box.extent()),
        sides_(sidesOf(fan, dimensions_)),
        strideB_(sides_.x + 2),
        planeStride_(strideB_ * (sides_.y + 2)) {
    while (planes_ > kMinPlanes && sweepBytes(fan_, dimensions_, planes_) > device.availableBytes()) planes_ /= 2;
    if (const std::uint64_t bytes = sweepBytes(fan_, dimensions_, planes_); bytes > device.availableBytes())
      fail(ErrorKind::OutOfMemory, "exact shadows of this light need {} MiB, and {} has {} MiB left: use {}", bytes >> 20,
           device.description().name, device.availableBytes() >> 20, Parameter("light-attenuation", "table"));
    slab_ =
        Buffer(device, slabVoxels() * sizeof(float), MemoryUse::Device, "extinction around rays", VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    slabTexels_ = TexelView(device, slab_, VK_FORMAT_R32_SFLOAT);
    carried_ = Buffer(device, fan.rays() * sizeof(float), MemoryUse::Device, "ray depths between slabs");
    groups_ = Buffer(device, (1 + groupCount(fan)) * sizeof(std::uint32_t), MemoryUse::Device, "groups of rays");
    if (!isIsland) upload(device, carried_, std::as_bytes(std::span<const float>(std::vector<float>(fan.rays(), 0.0f))));
    depths_ = Buffer(device, depthBytes(fan, planes_), MemoryUse::Device, "ray depths", VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    const std::uint64_t mostTexels = device.limits().maxTexelBufferElements;
    const bool depthsAreTexels = depths_.bytes() / sizeof(std::uint32_t) <= mostTexels;
    depthTexels_ = TexelView(device, depths_, VK_FORMAT_R32_UINT, depthsAreTexels ? depths_.bytes() : sizeof(std::uint32_t));
    frame_ = Buffer(device, sizeof(shader::LightPlanes), MemoryUse::Device, "planes of a light", VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    const std::size_t most = std::max(kept_.mostInALayer(), std::size_t(1));
    codes_ = Buffer(device, most * std::size_t(kBrickFace * planes_) * sizeof(std::uint16_t), MemoryUse::Device, "codes of light");
    bricks_ = Buffer(device, SweptBricks::kLayersOfSlab * most * sizeof(glm::ivec2), MemoryUse::Device, "bricks whose light is kept");
    if (Cells cells = cellsOfBricks(withData, box); cells.values.size() <= mostTexels) cells_.emplace(device, std::move(cells));
    sweep_ = makeComputePipeline(device, shaders::ray_sweep, {values.areScalars(), isIsland, cells_.has_value(), true});
    lookUp_ = makeComputePipeline(device, shaders::light_planes, {values.areScalars(), depthsAreTexels});
    if (!values.areScalars()) return;
    const std::vector<glm::vec4> texels = values.table().texels(kStoredDepth * level.outline().voxelSize());
    table_ = Buffer(device, texels.size() * sizeof(glm::vec4), MemoryUse::Device, "transfer function table",
                    VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    upload(device, table_, std::as_bytes(std::span(texels)));
    tableTexels_ = TexelView(device, table_);
  }

  void run(std::vector<StageTime>& times, const Progress& progress) {
    for (int begin = 0; begin < fan_.planeCount; begin += planes_) {
      if (progress) progress("sweeping light", double(begin) / double(fan_.planeCount));
      sweepPlanes(begin, std::min(begin + planes_, fan_.planeCount), times);
    }
    storeLayer();
    light_.codes_.flush();
  }

  /// Of an island: sweeps it with these depths in front of it, by ray, and returns those behind it.
  std::vector<float> runBehind(std::span<const float> before, std::vector<StageTime>& times, const Progress& progress) {
    upload(device_, carried_, std::as_bytes(before));
    run(times, progress);
    std::vector<float> behind(fan_.rays());
    download(device_, carried_, std::as_writable_bytes(std::span(behind)));
    return behind;
  }

 private:
  std::uint64_t slabVoxels() const { return freevoxels::slabVoxels(sides_, planes_); }
  int coordinateOf(int plane) const { return fan_.firstPlane + fan_.direction * plane; }

  /// The voxels of a layer of bricks; those of the last two layers stay in memory.
  const Volume& layer(int number) {
    const auto found = layers_.find(number);
    if (found != layers_.end()) return found->second;
    if (layers_.size() > 1) layers_.erase(fan_.direction > 0 ? layers_.begin() : std::prev(layers_.end()));
    VoxelRange box = box_;
    box.first[fan_.axis] += number * kEdge;
    box.end[fan_.axis] = std::min(box.first[fan_.axis] + kEdge, box_.end[fan_.axis]);
    return layers_.emplace(number, level_.source->read(level_.level, box)).first->second;
  }

  /// Writes a plane of the volume into a plane of the slab, whose border stays empty.
  void fill(int coordinate, std::span<float> plane) {
    std::ranges::fill(plane, values_.outside());
    if (coordinate < 0 || coordinate >= dimensions_[fan_.axis]) return;
    const ScalarBricks& bricks = layer(coordinate / kEdge).scalars;
    const int axisA = (fan_.axis + 1) % 3, axisB = (fan_.axis + 2) % 3;
    tbb::parallel_for(std::size_t(0), bricks.count(), [&](std::size_t i) {
      const ScalarBricks::Brick brick = bricks.brick(i);
      const glm::ivec3 first = bricks.firstVoxel(i), end = glm::min(bricks.dimensions() - first, kEdge);
      glm::ivec3 v;
      v[fan_.axis] = coordinate % kEdge;
      for (v[axisB] = 0; v[axisB] < end[axisB]; ++v[axisB])
        for (v[axisA] = 0; v[axisA] < end[axisA]; ++v[axisA])
          plane[std::size_t(first[axisA] + v[axisA] + 1 + strideB_ * (first[axisB] + v[axisB] + 1))] =
              values_.at(brick[ScalarBricks::indexInBrick(v)]);
    });
  }

  /// Fills the slab with planes from the one before `begin` on.
  void readSlab(int begin) {
    slabValues_.resize(slabVoxels());
    for (int i = 0; i <= planes_; ++i)
      fill(coordinateOf(begin - 1 + i),
           std::span(slabValues_).subspan(std::size_t(i) * std::size_t(planeStride_), std::size_t(planeStride_)));
    upload(device_, slab_, std::as_bytes(std::span(slabValues_)));
  }

  /// Marches the rays that are read.
  void recordRays(Commands& commands, const shader::FaceRays& fan, const shader::RaySlab& slab) {
    std::vector<std::uint32_t> groups = kept_.groupsOf(slab.begin, slab.end);
    const std::uint64_t count = groups.size();
    groups.insert(groups.begin(), std::uint32_t(count));
    upload(device_, groups_, std::as_bytes(std::span(groups)));
    commands.beginPass("light sweep");
    if (slab.begin > 0) {
      const VkDeviceSize pairBytes = fan_.rays() * sizeof(std::uint32_t);
      commands.copy(depths_, depths_, {.srcOffset = pairBytes * VkDeviceSize(planes_ / 2), .dstOffset = 0, .size = pairBytes});
      commands.barrier(kTransfer, kComputeStage);
    }
    if (count == 0) return;
    // Extinctions of the transfer function's table are in another unit.
    const double unit = values_.areScalars() ? 1.0 / (kStoredDepth * level_.outline().voxelSize()) : 1.0;
    const std::array<Binding, 6> bindings{&slabTexels_,
                                          &carried_,
                                          values_.areScalars() ? &tableTexels_ : &slabTexels_,
                                          cells_ ? &cells_->near() : &depthTexels_,
                                          cells_ ? &cells_->dimensions() : &carried_,
                                          &groups_};
    commands.dispatchLinear(sweep_, bindings,
                            shader::RaySweepPush{.fan = fan, .indexToWorld = unit * indexToWorld_, .sides = sides_, .slab = slab},
                            count * shader::kRaySweepThreads);
    commands.barrier(kComputeStage, kComputeStage);
  }

  /// Looks up the depths of the voxels in bricks whose light is kept, in the order of `stretches`. Returns the number of codes.
  std::size_t recordLookUps(Commands& commands, const shader::FaceRays& fan, const shader::RaySlab& slab,
                            std::span<const SweptBricks::Stretch> stretches) {
    commands.beginPass("light depths");
    commands.update(frame_, shader::LightPlanes{.fan = fan,
                                                .slab = slab,
                                                .sides = sides_,
                                                .indexToWorld = indexToWorld_,
                                                .place = source_.place,
                                                .atInfinity = source_.atInfinity ? 1 : 0,
                                                .fanIndex = fanNumber_});
    const std::array<Binding, 5> bindings{&frame_, &slabTexels_, &codes_, &bricks_, &depthTexels_};
    std::vector<glm::ivec2> bricks;
    std::size_t codeCount = 0;
    for (const SweptBricks::Stretch& stretch : stretches) {
      if (stretch.bricks.empty()) continue;
      const std::size_t perPlane = stretch.bricks.size() * kBrickFace;
      commands.dispatchLinear(lookUp_, bindings,
                              shader::LightPlanesPush{.rays = addressWords(depths_.address()),
                                                      .firstBrick = int(bricks.size()),
                                                      .brickCount = int(stretch.bricks.size()),
                                                      .firstPlane = stretch.begin,
                                                      .firstCode = int(codeCount / 2)},
                              perPlane / 2, std::uint32_t(stretch.end - stretch.begin));
      codeCount += perPlane * std::size_t(stretch.end - stretch.begin);
      bricks.insert(bricks.end(), stretch.bricks.begin(), stretch.bricks.end());
    }
    if (!bricks.empty()) upload(device_, bricks_, std::as_bytes(std::span(bricks)));
    return codeCount;
  }

  void sweepPlanes(int begin, int end, std::vector<StageTime>& times) {
    {
      const StageTimer timer(times, "read planes");
      readSlab(begin);
    }
    // The depths of plane 2k and 2k + 1 are in pair k; in the buffer, pair begin / 2 - 1 is the first. Places among all planes may wrap
    // around, as they do in the shaders.
    const VkDeviceSize pairBytes = fan_.rays() * sizeof(std::uint32_t);
    const shader::FaceRays fan = deviceFan(fan_, depths_.address() - pairBytes * VkDeviceSize(std::int64_t(begin / 2 - 1)));
    const shader::RaySlab slab{.begin = begin,
                               .end = end,
                               .origin = int(std::uint32_t(1 + strideB_) + std::uint32_t(1 - begin) * std::uint32_t(planeStride_)),
                               .planeStride = planeStride_,
                               .strideA = 1,
                               .strideB = strideB_};
    const std::vector<SweptBricks::Stretch> stretches = kept_.stretchesOf(begin, end);
    Commands commands(device_);
    recordRays(commands, fan, slab);
    std::vector<std::uint16_t> codes(recordLookUps(commands, fan, slab, stretches));
    commands.submitAndWait();
    addTimes(times, commands.times());
    const StageTimer timer(times, "keep light");
    if (!codes.empty()) download(device_, codes_, std::as_writable_bytes(std::span(codes)));
    std::span<const std::uint16_t> rest(codes);
    for (const SweptBricks::Stretch& stretch : stretches)
      for (int plane = stretch.begin; plane < stretch.end; ++plane) {
        keep(coordinateOf(plane), stretch.bricks, rest);
        rest = rest.subspan(stretch.bricks.size() * kBrickFace);
      }
  }

  /// Copies the codes of a plane into the bricks of its layer.
  void keep(int coordinate, std::span<const glm::ivec2> bricks, std::span<const std::uint16_t> codes) {
    const int number = coordinate / kEdge;
    if (number != keptLayer_) {
      storeLayer();
      keptLayer_ = number;
    }
    const int axisA = (fan_.axis + 1) % 3, axisB = (fan_.axis + 2) % 3;
    for (std::size_t i = 0; i < bricks.size(); ++i) {
      glm::ivec3 brick;
      brick[fan_.axis] = number;
      brick[axisA] = bricks[i].x;
      brick[axisB] = bricks[i].y;
      const auto [place, isNew] = layerCodes_.try_emplace(std::pair(bricks[i].y, bricks[i].x), box_.first / kEdge + brick, BrickCodes());
      BrickCodes& ofBrick = place->second.second;
      if (isNew) ofBrick.fill(std::uint16_t(shader::kOtherFan));
      const glm::ivec3 end = glm::min(dimensions_ - brick * kEdge, kEdge);
      glm::ivec3 v;
      v[fan_.axis] = coordinate % kEdge;
      for (v[axisB] = 0; v[axisB] < end[axisB]; ++v[axisB])
        for (v[axisA] = 0; v[axisA] < end[axisA]; ++v[axisA])
          ofBrick[ScalarBricks::indexInBrick(v)] = codes[i * kBrickFace + std::size_t(v[axisA] + v[axisB] * kEdge)];
    }
  }

  /// Adds the bricks of a layer to the file. What a voxel has through another face stays.
  void storeLayer() {
    for (auto& [place, kept] : layerCodes_) {
      auto& [brick, codes] = kept;
      std::uint32_t& record = light_.records_[brick];
      if (record != 0) {
        BrickCodes before;
        light_.codes_.readAt(std::uint64_t(record - 1) * sizeof(BrickCodes), std::as_writable_bytes(std::span(before)));
        for (std::size_t i = 0; i < codes.size(); ++i)
          if (codes[i] == shader::kOtherFan) codes[i] = before[i];
      }
      record = std::uint32_t(light_.codes_.bytes() / sizeof(BrickCodes)) + 1;
      light_.codes_.append(std::as_bytes(std::span(codes)));
    }
    layerCodes_.clear();
  }

  SweptLight& light_;
  const Device& device_;
  const SourceLevel& level_;
  const VoxelValues& values_;
  const VoxelRange box_;
  const FaceRays fan_;
  const SweptBricks kept_;  ///< bricks whose light is kept
  const int fanNumber_;
  const bool isIsland_;
  const glm::ivec3 dimensions_;  ///< of the box
  const glm::ivec2 sides_;
  const int strideB_, planeStride_;
  int planes_ = kMaxPlanes;
  const RaySource source_ = fromBox(light_.source_, box_);
  const glm::dmat3 indexToWorld_{level_.outline().indexToWorld};
  Buffer slab_, carried_, depths_, frame_, codes_, table_, bricks_, groups_;
  TexelView slabTexels_, tableTexels_, depthTexels_;
  std::optional<OccupiedCells> cells_;  ///< unless there are more than texels of a buffer
  Pipeline sweep_, lookUp_;
  std::vector<float> slabValues_;
  std::map<int, Volume> layers_;
  int keptLayer_ = -1;
  std::map<std::pair<int, int>, std::pair<glm::ivec3, BrickCodes>> layerCodes_;  ///< of the layer's bricks, by their places on its sides
};

namespace {

[[noreturn]] void failTemporary(const std::system_error& error) {
  fail(ErrorKind::Output,
       "the depths towards a light cannot be kept in a temporary file in {}: {}; make room there, or draw without shadows",
       std::filesystem::temp_directory_path().string(), error.code().message());
}

}  // namespace

SweptLight::SweptLight(const Device& device, const SourceLevel& level, const RaySource& source, std::vector<StageTime>& times,
                       const Progress& progress) try
    : source_(source), records_((level.outline().dimensions + kEdge - 1) / kEdge), codes_(std::filesystem::temp_directory_path()) {
  const VoxelValues values(level.outline(), level.classification);
  const SparseGrid<std::uint8_t> withData = level.source->bricks(level.level), around = withNeighbours(withData);
  std::vector<IslandRays> islands;
  for (const VoxelRange& box : sweptBoxes(level, around))
    islands.push_back({.box = box, .fans = faceRays(box.extent(), fromBox(source, box))});
  const bool areIslands = islands.size() > 1;
  const auto sweepOf = [&](const IslandRays& island, int face) {
    return Sweep(*this, device, level, values, withData, around, island.box, island.fans[std::size_t(face)], face, areIslands);
  };
  const auto forEachFace = [&](const auto& visit) {
    for (IslandRays& island : islands)
      for (int face = 0; face < 6; ++face)
        if (const FaceRays& fan = island.fans[std::size_t(face)]; fan.planeCount > 0) visit(island, face, fan);
  };
  if (!areIslands) {
    forEachFace([&](const IslandRays& island, int face, const FaceRays&) { sweepOf(island, face).run(times, progress); });
    return;
  }
  forEachFace([&](IslandRays& island, int face, const FaceRays& fan) {
    island.depths[std::size_t(face)] = sweepOf(island, face).runBehind(std::vector<float>(fan.rays(), 0.0f), times, progress);
  });
  const IslandShadows shadows(source_, islands);
  forEachFace([&](const IslandRays& island, int face, const FaceRays&) {
    if (const std::vector<float> before = shadows.before(std::size_t(&island - islands.data()), face); !before.empty())
      sweepOf(island, face).runBehind(before, times, progress);
  });
} catch (const std::system_error& error) {
  failTemporary(error);
}

std::uint64_t SweptLight::leastBytes(const SourceLevel& level, const RaySource& source) {
  std::uint64_t bytes = 0;
  for (const VoxelRange& box : sweptBoxes(level, withNeighbours(level.source->bricks(level.level))))
    for (const FaceRays& fan : faceRays(box.extent(), fromBox(source, box)))
      if (fan.planeCount > 0) bytes = std::max(bytes, sweepBytes(fan, box.extent(), kMinPlanes));
  return bytes;
}

void SweptLight::read(glm::ivec3 brick, std::span<std::uint16_t> codes) const {
  const std::uint32_t record = records_.at(brick);
  if (record == 0) {
    std::ranges::fill(codes, std::uint16_t(0));
    return;
  }
  codes_.readAt(std::uint64_t(record - 1) * sizeof(BrickCodes), std::as_writable_bytes(codes));
  std::ranges::replace(codes, std::uint16_t(shader::kOtherFan), std::uint16_t(0));
}

}  // namespace freevoxels
