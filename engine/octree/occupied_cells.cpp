#include "engine/octree/occupied_cells.h"

#include <span>
#include <tuple>
#include <utility>

#include "shaders/gather_interface.h"

namespace freevoxels {

static_assert(OccupiedCells::kEdge == 1 << shader::kSkipLevels);

OccupiedCells::OccupiedCells(const Device& device, Cells met)
    : met_(std::move(met)), dimensions_(device, sizeof(glm::ivec3), MemoryUse::Device, "dimensions of cells") {
  const Cells near = spread(met_, -1, 1);
  std::tie(near_, nearTexels_) = uploadTexels(device, std::as_bytes(std::span(near.values)), VK_FORMAT_R8_UINT, "cells near occupied ones");
  upload(device, dimensions_, std::as_bytes(std::span(&met_.dimensions, 1)));
}

}  // namespace freevoxels
