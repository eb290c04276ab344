#pragma once
// Walks the tree of a grid in an OpenVDB file without OpenVDB, which trusts the sizes that it reads: a wrong
// one makes OpenVDB 10 write past a buffer or allocate without end.

#include "engine/volume/vdb_header.h"
#include "engine/volume/vdb_reader.h"

namespace freevoxels {

/// `reader` stands at the tree and then behind it. Fails with ExitCode::Input where the tree is damaged.
/// False, and nothing is checked, where the layout is not known: points, and grids with a frustum transform.
bool checkVdbTree(VdbReader& reader, const VdbHeader::Grid& grid);

}  // namespace freevoxels
