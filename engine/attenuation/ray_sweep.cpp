#include "engine/attenuation/ray_sweep.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "embedded/expand_scalars.h"
#include "embedded/ray_sweep.h"
#include "engine/core/error.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

std::uint64_t depthBytes(const FaceRays& fan) {
  return fan.rays() * std::uint64_t((fan.planeCount + 1) / 2) * sizeof(std::uint32_t);
}

/// Bytes of the extinction of a slab, which fit into a processor's cache. More if a slab has kMinSlabPlanes, as each ray begins anew in it.
constexpr std::uint64_t kSlabBytes = std::uint64_t(8) << 20;
constexpr std::uint64_t kMinSlabPlanes = 32;
constexpr int kQuad = 4;  // number of voxels of a row that an invocation of ExpandPass writes

/// Rounds up to a multiple of a quad, negative numbers too.
int quadsUp(int voxels) { return (voxels + kQuad - 1) & -kQuad; }

/// The position in its quad of the volume's first voxel: quads of scalars do not cross the borders of bricks.
int shiftOfQuads(const DeviceVolume& volume, bool scalars) { return scalars ? volume.scalarBricks->corner.x % kQuad : 0; }

/// A part of the volume, with a border of empty voxels or quads on the sides of a face.
struct SlabBox {
  glm::ivec3 first, extent;

  std::uint64_t bytes() const {
    return std::uint64_t(extent.x) * std::uint64_t(extent.y) * std::uint64_t(extent.z) * sizeof(float);
  }
};

/// The box of the planes `begin` to `end` - 1 of a face, rounded up to an even number, and of the plane
/// before them.
SlabBox slabBox(const FaceRays& fan, glm::ivec3 dimensions, int begin, int end, int shift) {
  SlabBox box{.first = glm::ivec3(-kQuad - shift, -1, -1),
              .extent = {quadsUp(dimensions.x + shift) + 2 * kQuad, dimensions.y + 2, dimensions.z + 2}};
  const int near = fan.firstPlane + fan.direction * (begin - 1);
  const int far = fan.firstPlane + fan.direction * (end + end % 2 - 1);
  int low = std::min(near, far), high = std::max(near, far) + 1;
  if (fan.axis == 0) {
    low = quadsUp(low + shift - kQuad + 1) - shift;
    high = quadsUp(high + shift) - shift;
  }
  box.first[fan.axis] = low;
  box.extent[fan.axis] = high - low;
  return box;
}

/// Number of planes of a slab, a multiple of four.
int planesPerSlab(const FaceRays& fan, glm::ivec3 dimensions) {
  glm::ivec3 plane = dimensions + 2;
  plane[fan.axis] = 1;
  const std::uint64_t bytes = SlabBox{.first = {}, .extent = plane}.bytes();
  const std::uint64_t most = std::uint64_t(quadsUp(fan.planeCount));
  return int(std::min(std::max(kSlabBytes / bytes, kMinSlabPlanes), most)) / kQuad * kQuad;
}

/// Without a slab.
RayRoom roomForRays(const std::array<FaceRays, 6>& fans) {
  RayRoom room{.slab = sizeof(glm::vec4), .carried = sizeof(float)};  // bindings need buffers even if no face has rays
  for (const FaceRays& fan : fans) {
    if (fan.planeCount == 0) continue;
    room.depths += depthBytes(fan);
    room.largest = std::max(room.largest, depthBytes(fan));
    room.carried = std::max(room.carried, fan.rays() * sizeof(float));
  }
  return room;
}

RayRoom roomFor(const std::array<FaceRays, 6>& fans, glm::ivec3 dimensions) {
  RayRoom room = roomForRays(fans);
  for (const FaceRays& fan : fans) {
    const int planes = planesPerSlab(fan, dimensions);
    for (int begin = 0; begin < fan.planeCount; begin += planes) {
      const int end = std::min(begin + planes, fan.planeCount);
      for (int shift = 0; shift < kQuad; ++shift) room.slab = std::max(room.slab, slabBox(fan, dimensions, begin, end, shift).bytes());
    }
  }
  return room;
}

/// `needs` begins the sentence, `without` is the parameter that does without the rays.
void checkFits(const Device& device, const RayRoom& room, std::uint64_t mostBytes, const char* needs, const Parameter& without) {
  // Shaders index the depths of a face with 31 bits.
  const std::uint64_t most = std::uint64_t(std::numeric_limits<std::int32_t>::max()) * sizeof(std::uint32_t);
  const std::uint64_t fits = std::min(std::uint64_t(device.maximumAllocation()), mostBytes);
  if (room.bytes() > mostBytes || room.depths > fits || room.largest > most)
    fail(ErrorKind::OutOfMemory,
         "{} needs {} MiB of device memory for its rays, and {} can allocate {} MiB at once: use {}, or a smaller volume", needs,
         room.bytes() >> 20, device.description().name, std::min(fits, most) >> 20, without);
}

}  // namespace

shader::FaceRays deviceFan(const FaceRays& fan, VkDeviceAddress depths) {
  return {.axis = fan.axis,
          .direction = fan.direction,
          .firstPlane = fan.firstPlane,
          .planeCount = fan.planeCount,
          .rayCount = fan.rayCount,
          .origin = fan.origin,
          .slope = fan.slope,
          .convergence = float(fan.convergence),
          .farthest = float(fan.farthest),
          .spacing = float(fan.spacing),
          .depths = addressWords(depths)};
}

std::uint64_t rayBytes(glm::ivec3 dimensions, const RaySource& source) {
  return roomFor(faceRays(dimensions, source), dimensions).bytes();
}

std::uint64_t denseRayBytes(glm::ivec3 dimensions, const RaySource& source) {
  return roomForRays(faceRays(dimensions, source)).bytes();
}

RaySweep::RaySweep(const Device& device, const char* name)
    : device_(device),
      name_(name),
      expand_(device) {}

void RaySweep::makeRoom(const RayRoom& room, const char* needs, const Parameter& without) {
  const std::uint64_t own = depths_.bytes() + slab_.bytes() + carried_.bytes();
  checkFits(device_, room, device_.availableBytes() + own, needs, without);
  if (growBuffer(device_, depths_, room.depths, "ray depths", VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT)) {
    depthTexels_.reset();
    // Shaders find texels by 32 bits of the addresses.
    if (room.depths / sizeof(std::uint32_t) <= device_.limits().maxTexelBufferElements &&
        room.depths <= std::numeric_limits<std::uint32_t>::max())
      depthTexels_.emplace(device_, depths_, VK_FORMAT_R32_UINT);
  }
  growBuffer(device_, carried_, room.carried, "ray depths between slabs");
  if (growBuffer(device_, slab_, room.slab, "extinction around rays",
                 VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT)) {
    slabTexels_ = TexelView(device_, slab_, VK_FORMAT_R32_SFLOAT);
    slabQuads_ = TexelView(device_, slab_, VK_FORMAT_R32G32B32A32_SFLOAT);
    noTexels_ = TexelView(device_, slab_, VK_FORMAT_R32_UINT, sizeof(std::uint32_t));
  }
}

/// Expands the extinction of a box of voxels from the scalars.
void RaySweep::recordScalars(Commands& commands, const DeviceVolume& volume, glm::ivec3 first, glm::ivec3 extent) const {
  const glm::ivec3 quads(extent.x / kQuad, extent.y, extent.z);
  const shader::ExpandScalarsPush push{
      .first = first, .extent = quads, .dimensions = volume.layout.dimensions, .scalars = volume.scalarBricks->onDevice()};
  const bool texels = volume.scalarBricks->codeTexels.has_value();
  const std::array<Binding, 3> bindings{&slabQuads_, texels ? &*volume.scalarBricks->codeTexels : &noTexels_,
                                        texels ? &*volume.scalarBricks->numberTexels : &noTexels_};
  commands.dispatch(makeComputePipeline(device_, shaders::expand_scalars, {texels}), bindings, push, quads);
  commands.barrier(kComputeStage, kComputeStage);
}

void RaySweep::recordFan(Commands& commands, const DeviceVolume& volume, const FaceRays& fan, const shader::FaceRays& onDevice,
                         bool scalars, const OccupiedCells* cells) const {
  const glm::ivec3 dimensions = volume.layout.dimensions;
  // Extinctions of the transfer table are in another unit.
  const double unit = scalars ? 1.0 / (kStoredDepth * volume.voxelSize) : 1.0;
  const int planes = planesPerSlab(fan, dimensions), shift = shiftOfQuads(volume, scalars);
  for (int begin = 0; begin < fan.planeCount; begin += planes) {
    const int end = std::min(begin + planes, fan.planeCount);
    const SlabBox box = slabBox(fan, dimensions, begin, end, shift);
    if (scalars)
      recordScalars(commands, volume, box.first, box.extent);
    else
      expand_.recordBox(commands, volume, box.first, box.extent, slab_);
    recordBox(commands, onDevice,
              {.begin = begin,
               .end = end,
               .first = box.first,
               .extent = box.extent,
               .dimensions = dimensions,
               .indexToWorld = unit * glm::dmat3(volume.indexToWorld),
               .extinction = slabTexels_,
               .table = scalars ? volume.scalarBricks->tableTexels : slabTexels_,
               .cells = cells},
              scalars);
  }
}

void RaySweep::recordBox(Commands& commands, const shader::FaceRays& fan, const SweptBox& box, bool scalars) const {
  const int sideA = (fan.axis + 1) % 3, sideB = (fan.axis + 2) % 3;
  const glm::ivec3 strides(1, box.extent.x, box.extent.x * box.extent.y);
  glm::ivec3 origin = -box.first;
  origin[fan.axis] += fan.firstPlane;
  const glm::ivec3 offsets = origin * strides;
  const shader::RaySweepPush push{.fan = fan,
                                  .indexToWorld = box.indexToWorld,
                                  .sides = {box.dimensions[sideA], box.dimensions[sideB]},
                                  .slab = {.begin = box.begin,
                                           .end = box.end,
                                           .origin = offsets.x + offsets.y + offsets.z,
                                           .planeStride = fan.direction * strides[fan.axis],
                                           .strideA = strides[sideA],
                                           .strideB = strides[sideB]}};
  const OccupiedCells* const cells = box.cells;
  const std::array<Binding, 6> bindings{&box.extinction,
                                        &carried_,
                                        &box.table,
                                        cells != nullptr ? &cells->near() : &noTexels_,
                                        cells != nullptr ? &cells->dimensions() : &carried_,
                                        &carried_};
  commands.dispatchLinear(makeComputePipeline(device_, shaders::ray_sweep, {scalars, false, cells != nullptr, false}), bindings, push,
                          std::uint64_t(fan.rayCount.x) * std::uint64_t(fan.rayCount.y));
  commands.barrier(kComputeStage, kComputeStage);
}

/// Places the rays of all faces one behind the other in depths_, and calls recordFan(face, face on the device) for each that has some.
template <typename RecordFan>
void RaySweep::recordFans(const std::array<FaceRays, 6>& fans, const RecordFan& recordFan) {
  VkDeviceAddress address = depths_.address();
  for (std::size_t i = 0; i < fans.size(); ++i) {
    fans_[i] = deviceFan(fans[i], address);
    if (fans[i].planeCount == 0) continue;
    recordFan(fans[i], fans_[i]);
    address += depthBytes(fans[i]);
    if (fans[i].convergence == 0.0) {  // parallel
      fans_.fill(fans_[i]);
      break;
    }
  }
}

void RaySweep::record(Commands& commands, const DeviceVolume& volume, const RaySource& source, bool scalars, const OccupiedCells* cells) {
  const std::array<FaceRays, 6> fans = faceRays(volume.layout.dimensions, source);
  makeRoom(roomFor(fans, volume.layout.dimensions), "exact transmittance", Parameter("light-attenuation", "table"));
  commands.beginPass(name_);
  recordFans(fans,
             [&](const FaceRays& fan, const shader::FaceRays& onDevice) { recordFan(commands, volume, fan, onDevice, scalars, cells); });
}

void RaySweep::record(Commands& commands, const DenseExtinction& grid, const RaySource& source) {
  const std::array<FaceRays, 6> fans = faceRays(grid.dimensions, source);
  makeRoom(roomForRays(fans), "the direct part of scattered light", Parameter("scattering", "1"));
  commands.beginPass(name_);
  recordFans(fans, [&](const FaceRays& fan, const shader::FaceRays& onDevice) {
    recordBox(commands, onDevice,
              {.begin = 0,
               .end = fan.planeCount,
               .first = glm::ivec3(-1),
               .extent = grid.dimensions + 2,
               .dimensions = grid.dimensions,
               .indexToWorld = grid.indexToWorld,
               .extinction = grid.texels,
               .table = grid.texels,
               .cells = nullptr},
              false);
  });
}

RayCodes RaySweep::sweep(const DeviceVolume& volume, const RaySource& source, bool scalars, const OccupiedCells* cells) {
  Commands commands(device_);
  record(commands, volume, source, scalars, cells);
  commands.submitAndWait();
  const std::array<FaceRays, 6> fans = faceRays(volume.layout.dimensions, source);
  RayCodes codes;
  std::uint64_t first = 0;
  for (std::size_t f = 0; f < fans.size(); ++f) {
    const std::uint64_t rays = fans[f].rays();
    std::vector<std::uint32_t> pairs(depthBytes(fans[f]) / sizeof(std::uint32_t));
    if (pairs.empty()) continue;
    download(device_, depths_, std::as_writable_bytes(std::span(pairs)), first);
    first += depthBytes(fans[f]);
    codes[f].resize(rays * std::uint64_t(fans[f].planeCount));
    for (std::uint64_t i = 0; i < codes[f].size(); ++i) {
      const std::uint64_t plane = i / rays;
      codes[f][i] = std::uint16_t(pairs[plane / 2 * rays + i % rays] >> (plane % 2 * 16));
    }
  }
  return codes;
}

}  // namespace freevoxels
