#include "engine/attenuation/plane_sweep.h"

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
#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/octree/device_volume.h"
#include "engine/volume/transfer_table.h"
#include "engine/vulkan/commands.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

constexpr int kEdge = ScalarBricks::kEdge;
constexpr VkPipelineStageFlags2 kTransfer = VK_PIPELINE_STAGE_2_TRANSFER_BIT;
constexpr int kMaxPlanes = 8, kMinPlanes = 2;  ///< that are swept at a time

std::uint64_t slabVoxels(glm::ivec2 sides, int planes) {
  return std::uint64_t(planes + 1) * std::uint64_t(sides.x + 2) * std::uint64_t(sides.y + 2);
}

/// The pairs of planes of a slab, and the pair before them.
std::uint64_t depthBytes(const FaceRays& fan, int planes) {
  return fan.rays() * std::uint64_t(planes / 2 + 1) * sizeof(std::uint32_t);
}

std::uint64_t codeWords(glm::ivec2 sides) {
  return std::uint64_t((sides.x + 1) / 2) * std::uint64_t(sides.y);
}

/// What a face of a sweep takes on the device.
std::uint64_t sweepBytes(const FaceRays& fan, glm::ivec2 sides, int planes) {
  return slabVoxels(sides, planes) * sizeof(float) + fan.rays() * sizeof(float) + depthBytes(fan, planes) +
         codeWords(sides) * std::uint64_t(planes) * sizeof(std::uint32_t);
}

glm::ivec2 sidesOf(const FaceRays& fan, glm::ivec3 dimensions) {
  return {dimensions[(fan.axis + 1) % 3], dimensions[(fan.axis + 2) % 3]};
}

/// What a sweep looks up of a voxel: its extinction per world unit, or its scalar in intervals of the transfer function's table.
class VoxelValues {
 public:
  explicit VoxelValues(const SourceLevel& level) : classification_(level.classification) {
    const Volume& volume = level.outline();
    if (classification_.isPost(volume)) table_.emplace(*classification_.transferFunction, volume.minimum, volume.maximum);
  }
  bool areScalars() const { return table_.has_value(); }
  float outside() const { return areScalars() ? -1.0f : 0.0f; }
  const TransferTable& table() const { return *table_; }
  float at(float scalar) const {
    if (!areScalars()) return float(classify(classification_, scalar).extinction);
    const std::uint16_t code = table_->code(scalar);
    return code == 0 ? -1.0f : (float(code) - 1.0f) * (float(shader::kTransferIntervals) / float(shader::kScalarCodes));
  }

 private:
  const Classification& classification_;
  std::optional<TransferTable> table_;
};

}  // namespace

SparseGrid<std::uint8_t> bricksAround(const SourceLevel& level) {
  SparseGrid<std::uint8_t> around = level.source->bricks(level.level);
  for (int axis = 0; axis < 3; ++axis) {
    const SparseGrid<std::uint8_t> from = around;
    from.forEach([&](glm::ivec3 brick, std::uint8_t) {
      for (const int by : {-1, 1}) {
        glm::ivec3 beside = brick;
        beside[axis] += by;
        if (beside[axis] >= 0 && beside[axis] < from.dimensions()[axis]) around[beside] = 1;
      }
    });
  }
  return around;
}

namespace {

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
  /// `around` marks the bricks whose codes are kept. With `isIsland`, there are further boxes.
  Sweep(SweptLight& light, const Device& device, const SourceLevel& level, const VoxelValues& values,
        const SparseGrid<std::uint8_t>& around, const VoxelRange& box, const FaceRays& fan, int fanNumber, bool isIsland)
      : light_(light),
        device_(device),
        level_(level),
        values_(values),
        around_(around),
        box_(box),
        fan_(fan),
        fanNumber_(fanNumber),
        isIsland_(isIsland),
        dimensions_(box.extent()),
        sides_(sidesOf(fan, dimensions_)),
        strideB_(sides_.x + 2),
        planeStride_(strideB_ * (sides_.y + 2)) {
    while (planes_ > kMinPlanes && sweepBytes(fan_, sides_, planes_) > device.availableBytes()) planes_ /= 2;
    if (const std::uint64_t bytes = sweepBytes(fan_, sides_, planes_); bytes > device.availableBytes())
      fail(ErrorKind::OutOfMemory, "exact shadows of this light need {} MiB, and {} has {} MiB left: use {}", bytes >> 20,
           device.description().name, device.availableBytes() >> 20, Parameter("light-attenuation", "table"));
    slab_ = Buffer(device, slabVoxels() * sizeof(float), MemoryUse::Device, "extinction around rays", VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    slabTexels_ = TexelView(device, slab_, VK_FORMAT_R32_SFLOAT);
    noTexels_ = TexelView(device, slab_, VK_FORMAT_R32_UINT, sizeof(std::uint32_t));
    carried_ = Buffer(device, fan.rays() * sizeof(float), MemoryUse::Device, "ray depths between slabs");
    depths_ = Buffer(device, depthBytes(fan, planes_), MemoryUse::Device, "ray depths");
    frame_ = Buffer(device, sizeof(shader::LightPlanes), MemoryUse::Device, "planes of a light", VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    codes_ = Buffer(device, codeWords() * std::uint64_t(planes_) * sizeof(std::uint32_t), MemoryUse::Device, "codes of light");
    sweep_ = makeComputePipeline(device, shaders::ray_sweep, {values.areScalars(), isIsland, false});
    lookUp_ = makeComputePipeline(device, shaders::light_planes, {values.areScalars()});
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
  std::uint64_t codeWords() const { return freevoxels::codeWords(sides_); }
  int coordinateOf(int plane) const { return fan_.firstPlane + fan_.direction * plane; }

  /// The bricks of the layer that has a plane; those of the last two layers are kept.
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
    for (std::size_t i = 0; i < bricks.bricks().size(); ++i) {
      const ScalarBricks::Brick& brick = bricks.bricks()[i];
      const glm::ivec3 first = bricks.firstVoxel(i), end = glm::min(bricks.dimensions() - first, kEdge);
      glm::ivec3 v;
      v[fan_.axis] = coordinate % kEdge;
      for (v[axisB] = 0; v[axisB] < end[axisB]; ++v[axisB])
        for (v[axisA] = 0; v[axisA] < end[axisA]; ++v[axisA])
          plane[std::size_t(first[axisA] + v[axisA] + 1 + strideB_ * (first[axisB] + v[axisB] + 1))] =
              values_.at(brick[ScalarBricks::indexInBrick(v)]);
    }
  }

  void sweepPlanes(int begin, int end, std::vector<StageTime>& times) {
    {
      const StageTimer timer(times, "read planes");
      std::vector<float> slab(slabVoxels());
      for (int i = 0; i <= planes_; ++i)
        fill(coordinateOf(begin - 1 + i), std::span(slab).subspan(std::size_t(i) * std::size_t(planeStride_), std::size_t(planeStride_)));
      upload(device_, slab_, std::as_bytes(std::span(slab)));
    }
    // The depths of plane 2k and 2k + 1 are in pair k; in the buffer, pair begin / 2 - 1 is the first. Places among all planes may wrap
    // around, as they do in the shaders.
    const VkDeviceSize pairBytes = fan_.rays() * sizeof(std::uint32_t);
    const VkDeviceAddress depths = depths_.address() - pairBytes * VkDeviceSize(std::int64_t(begin / 2 - 1));
    const shader::FaceRays fan = deviceFan(fan_, depths);
    const shader::RaySlab place{.begin = begin,
                                .end = end,
                                .origin = int(std::uint32_t(1 + strideB_) + std::uint32_t(1 - begin) * std::uint32_t(planeStride_)),
                                .planeStride = planeStride_,
                                .strideA = 1,
                                .strideB = strideB_};
    // Extinctions of the transfer function's table are in another unit.
    const double unit = values_.areScalars() ? 1.0 / (kStoredDepth * level_.outline().voxelSize()) : 1.0;
    Commands commands(device_);
    commands.beginPass("light sweep");
    if (begin > 0) {
      commands.copy(depths_, depths_, {.srcOffset = pairBytes * VkDeviceSize(planes_ / 2), .dstOffset = 0, .size = pairBytes});
      commands.barrier(kTransfer, kComputeStage);
    }
    const TexelView& table = values_.areScalars() ? tableTexels_ : slabTexels_;
    const std::array<Binding, 5> rays{&slabTexels_, &carried_, &table, &noTexels_, &carried_};
    commands.dispatchLinear(sweep_, rays, shader::RaySweepPush{.fan = fan, .indexToWorld = unit * indexToWorld_, .sides = sides_, .slab = place},
                            fan_.rays());
    commands.barrier(kComputeStage, kComputeStage);
    commands.beginPass("light depths");
    commands.update(frame_, shader::LightPlanes{.fan = fan,
                                                .slab = place,
                                                .sides = sides_,
                                                .indexToWorld = indexToWorld_,
                                                .place = source_.place,
                                                .atInfinity = source_.atInfinity ? 1 : 0,
                                                .fanIndex = fanNumber_});
    const std::array<Binding, 3> lookUps{&frame_, &slabTexels_, &codes_};
    commands.dispatch(lookUp_, lookUps, glm::ivec3((sides_.x + 1) / 2, sides_.y, end - begin));
    commands.submitAndWait();
    addTimes(times, commands.times());
    const StageTimer timer(times, "keep light");
    std::vector<std::uint16_t> codes(2 * codeWords() * std::size_t(planes_));
    download(device_, codes_, std::as_writable_bytes(std::span(codes)));
    for (int plane = begin; plane < end; ++plane)
      keep(coordinateOf(plane), std::span(codes).subspan(std::size_t(plane - begin) * 2 * codeWords(), 2 * codeWords()));
  }

  /// Copies the codes of a plane into the bricks of its layer.
  void keep(int coordinate, std::span<const std::uint16_t> codes) {
    const int number = coordinate / kEdge;
    if (number != keptLayer_) {
      storeLayer();
      keptLayer_ = number;
    }
    const int axisA = (fan_.axis + 1) % 3, axisB = (fan_.axis + 2) % 3;
    const glm::ivec3 bricks = (dimensions_ + kEdge - 1) / kEdge, firstBrick = box_.first / kEdge;
    glm::ivec3 brick;
    brick[fan_.axis] = number;
    for (brick[axisB] = 0; brick[axisB] < bricks[axisB]; ++brick[axisB])
      for (brick[axisA] = 0; brick[axisA] < bricks[axisA]; ++brick[axisA]) {
        if (around_.at(firstBrick + brick) == 0) continue;
        const auto [place, isNew] = kept_.try_emplace(std::pair(brick[axisB], brick[axisA]), firstBrick + brick, BrickCodes());
        BrickCodes& ofBrick = place->second.second;
        if (isNew) ofBrick.fill(std::uint16_t(shader::kOtherFan));
        const glm::ivec3 end = glm::min(dimensions_ - brick * kEdge, kEdge);
        glm::ivec3 v;
        v[fan_.axis] = coordinate % kEdge;
        for (v[axisB] = 0; v[axisB] < end[axisB]; ++v[axisB])
          for (v[axisA] = 0; v[axisA] < end[axisA]; ++v[axisA]) {
            const int a = brick[axisA] * kEdge + v[axisA], b = brick[axisB] * kEdge + v[axisB];
            ofBrick[ScalarBricks::indexInBrick(v)] = codes[std::size_t(a) + std::size_t(b) * std::size_t((sides_.x + 1) / 2 * 2)];
          }
      }
  }

  /// Adds the bricks of a layer to the file. What a voxel has through another face stays.
  void storeLayer() {
    for (auto& [place, kept] : kept_) {
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
    kept_.clear();
  }

  SweptLight& light_;
  const Device& device_;
  const SourceLevel& level_;
  const VoxelValues& values_;
  const SparseGrid<std::uint8_t>& around_;
  const VoxelRange box_;
  const FaceRays fan_;
  const int fanNumber_;
  const bool isIsland_;
  const glm::ivec3 dimensions_;  ///< of the box
  const glm::ivec2 sides_;
  const int strideB_, planeStride_;
  int planes_ = kMaxPlanes;
  const RaySource source_ = fromBox(light_.source_, box_);
  const glm::dmat3 indexToWorld_{level_.outline().indexToWorld};
  Buffer slab_, carried_, depths_, frame_, codes_, table_;
  TexelView slabTexels_, tableTexels_;
  TexelView noTexels_;  ///< bound where shaders read none
  Pipeline sweep_, lookUp_;
  std::map<int, Volume> layers_;
  int keptLayer_ = -1;
  std::map<std::pair<int, int>, std::pair<glm::ivec3, BrickCodes>> kept_;  ///< of the layer's bricks, by their places on its sides
};

namespace {

[[noreturn]] void failTemporary(const std::system_error& error) {
  fail(ErrorKind::Output, "the depths towards a light cannot be kept in a temporary file in {}: {}; make room there, or draw without shadows",
       std::filesystem::temp_directory_path().string(), error.code().message());
}

}  // namespace

SweptLight::SweptLight(const Device& device, const SourceLevel& level, const RaySource& source, std::vector<StageTime>& times,
                       const Progress& progress) try
    : source_(source), records_((level.outline().dimensions + kEdge - 1) / kEdge), codes_(std::filesystem::temp_directory_path()) {
  const VoxelValues values(level);
  const SparseGrid<std::uint8_t> around = bricksAround(level);
  std::vector<IslandRays> islands;
  for (const VoxelRange& box : sweptBoxes(level, around))
    islands.push_back({.box = box, .fans = faceRays(box.extent(), fromBox(source, box))});
  const bool areIslands = islands.size() > 1;
  const auto sweepOf = [&](const IslandRays& island, int face) {
    return Sweep(*this, device, level, values, around, island.box, island.fans[std::size_t(face)], face, areIslands);
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
  for (const VoxelRange& box : sweptBoxes(level, bricksAround(level)))
    for (const FaceRays& fan : faceRays(box.extent(), fromBox(source, box)))
      if (fan.planeCount > 0) bytes = std::max(bytes, sweepBytes(fan, sidesOf(fan, box.extent()), kMinPlanes));
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
