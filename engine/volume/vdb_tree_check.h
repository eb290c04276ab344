#pragma once
// Walks the tree of a grid in an OpenVDB file without OpenVDB, which trusts the sizes that it reads: a wrong
// one makes OpenVDB 10 write beyond a buffer or allocate without limit.

#include "engine/core/stages.h"
#include "engine/volume/vdb_header.h"
#include "engine/volume/vdb_reader.h"

namespace freevoxels {

/// `reader` must be at the tree, and is behind it afterwards. Fails with ErrorKind::Input if the tree is
/// damaged. Returns false without checking anything if the layout is unknown: points, and grids with a
/// frustum transform. `progress` may abandon it.
bool checkVdbTree(VdbReader& reader, const VdbHeader::Grid& grid, const Progress& progress = {});

}  // namespace freevoxels
