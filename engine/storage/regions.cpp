#include "engine/storage/regions.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "engine/core/error.h"
#include "engine/scene/directions.h"

namespace freevoxels::fvx {

namespace {

constexpr float kLargestCode = 65535.0f;

}  // namespace

VoxelBox regionVoxels(glm::ivec3 cell, glm::ivec3 dimensions) {
  const glm::ivec3 first = cell * kRegionEdge;
  return {first, glm::min(first + kRegionEdge, dimensions)};
}

VoxelBox regionWithHalo(glm::ivec3 cell, glm::ivec3 dimensions) {
  const VoxelBox own = regionVoxels(cell, dimensions);
  return {glm::max(own.first - kRegionHalo, 0), glm::min(own.end + kRegionHalo, dimensions)};
}

const std::array<EntryFace, kEntryFaces>& entryFaces() {
  static const std::array<EntryFace, kEntryFaces> faces = [] {
    std::array<EntryFace, kEntryFaces> all;
    std::size_t next = 0;
    for (int i = 0; i < directionCount(DirectionSet::Directions26); ++i) {
      const glm::ivec3 direction = directionCell(DirectionSet::Directions26, i);
      for (int axis = 0; axis < 3; ++axis)
        if (direction[axis] != 0) all.at(next++) = {direction, axis};
    }
    FV_CHECK_EQ(next, all.size());
    return all;
  }();
  return faces;
}

std::size_t faceVoxels(glm::ivec3 extent, int axis) {
  return std::size_t(extent[(axis + 1) % 3]) * std::size_t(extent[(axis + 2) % 3]);
}

namespace {

/// Takes the codes of the stored faces from the beginning of `bytes`.
EntryDepths takeDepths(glm::ivec3 extent, std::uint64_t parts, std::span<const std::byte>& bytes) {
  EntryDepths result;
  std::size_t total = 0;
  for (std::size_t i = 0; i < kEntryFaces; ++i) {
    result.first[i] = total;
    total += faceVoxels(extent, entryFaces()[i].axis);
  }
  result.values.assign(total, 0.0f);
  for (std::size_t i = 0; i < kEntryFaces; ++i) {
    if ((parts >> i & 1u) == 0) continue;
    std::vector<std::uint16_t> codes(faceVoxels(extent, entryFaces()[i].axis));
    const std::size_t size = codes.size() * sizeof(std::uint16_t);
    std::memcpy(codes.data(), bytes.data(), size);
    std::ranges::transform(codes, result.values.begin() + std::ptrdiff_t(result.first[i]), decodeEntryDepth);
    bytes = bytes.subspan(size);
  }
  return result;
}

}  // namespace

std::uint64_t regionBytes(glm::ivec3 cell, glm::ivec3 dimensions, std::uint64_t parts, const Encoding& encoding) {
  const glm::ivec3 extent = regionWithHalo(cell, dimensions).extent();
  std::uint64_t bytes = (parts & kHaloPart) != 0 ? haloVoxels(cell, dimensions) * encoding.bytesPerValue() : 0;
  for (std::size_t i = 0; i < kEntryFaces; ++i)
    if ((parts >> i & 1u) != 0) bytes += faceVoxels(extent, entryFaces()[i].axis) * sizeof(std::uint16_t);
  return bytes;
}

std::optional<RegionSurroundings> decodeRegion(glm::ivec3 cell, glm::ivec3 dimensions, std::uint64_t parts, const Encoding& encoding,
                                               std::span<const std::byte> bytes) {
  FV_CHECK_EQ(bytes.size(), regionBytes(cell, dimensions, parts, encoding));
  RegionSurroundings result{.depths = takeDepths(regionWithHalo(cell, dimensions).extent(), parts, bytes), .halo = {}};
  if ((parts & kHaloPart) == 0) return result;
  result.halo.resize(haloVoxels(cell, dimensions));
  if (!Decoder(encoding).decode(bytes, result.halo)) return std::nullopt;
  return result;
}

std::uint16_t encodeEntryDepth(float depth) {
  return std::uint16_t(std::sqrt(std::min(depth, kLargestEntryDepth) / kLargestEntryDepth) * kLargestCode + 0.5f);
}

float decodeEntryDepth(std::uint16_t code) {
  const float root = float(code) / kLargestCode;
  return kLargestEntryDepth * root * root;
}

}  // namespace freevoxels::fvx
