#pragma once
// Internal to the vdb_*.cpp files, since it includes OpenVDB: reads a grid of a file in a way that can be abandoned, which
// openvdb::io::File cannot.

#include <openvdb/Grid.h>

#include <filesystem>

#include "engine/core/stages.h"
#include "engine/volume/vdb_header.h"

namespace freevoxels {

/// Reads a grid that has a tree of its own, with all values. `progress` is called at every few MiB of the file; an exception that it throws
/// is passed on, as those of OpenVDB are. OpenVDB must be initialised.
openvdb::GridBase::Ptr readVdbGrid(const std::filesystem::path& file, const VdbHeader::Grid& grid, const Progress& progress);

}  // namespace freevoxels
