#pragma once
// Where a volume has something to see, in cells of several voxels.

#include "engine/volume/classification.h"
#include "engine/volume/coarse_cells.h"
#include "engine/vulkan/buffer.h"

namespace freevoxels {

class OccupiedCells {
 public:
  static constexpr int kEdge = 4;  ///< voxels

  /// `met` marks cells of kEdge.
  OccupiedCells(const Device& device, Cells met);
  const Cells& met() const { return met_; }
  /// On the device, a byte for each cell, x fastest: 1 if it or one of its 26 neighbours is met, otherwise 0.
  const TexelView& near() const { return nearTexels_; }
  /// On the device, an ivec3: the number of cells along the axes.
  const Buffer& dimensions() const { return dimensions_; }

 private:
  Cells met_;
  Buffer near_, dimensions_;
  TexelView nearTexels_;
};

}  // namespace freevoxels
