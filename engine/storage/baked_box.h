#pragma once
// Reading a part of a baked volume.

#include "engine/storage/fvx_file.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Reads a box of a level as a volume of its own, which keeps the whole level's ranges and has its part of the bricks. The box begins at
/// multiples of ScalarBricks::kEdge, and ends at such or with the level. Fails with ErrorKind::Input if a chunk is damaged.
Volume readBakedBox(const fvx::FvxFile& file, int level, const fvx::VoxelBox& box);

}  // namespace freevoxels
