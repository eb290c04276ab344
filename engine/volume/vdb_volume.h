#pragma once
// Internal to the vdb_*.cpp files, since it includes OpenVDB: what volumes have in common that are read whole and in parts.

#include <cstdint>
#include <string>

#include "engine/volume/vdb_density.h"
#include "engine/volume/vdb_grids.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Voxels of a box that is not read at once.
inline constexpr double kMaxVoxels = 1e12;

/// Voxels along an edge of a box, to which margins and edges of bricks are added.
inline constexpr std::int64_t kLongestReadEdge = 1 << 30;

double voxelsIn(glm::i64vec3 extent);

/// Fails with ErrorKind::Input for types and transforms of grids that cannot be drawn.
void checkUsable(VdbFile& file, const VdbFile::Entry& entry);
std::string whyUnusable(const VdbFile& file, const VdbFile::Entry& entry, const std::string& why);

/// The place of a box of voxels, without these.
Volume boxVolume(const openvdb::math::Transform& transform, const openvdb::CoordBBox& bounds, const std::string& source);

/// 16-bit floats beyond their range are infinite in the file, and become the largest of it.
void limitOverflow(ScalarBricks& scalars, std::uint64_t& overflown);

/// Adds what the file says of the volume, once the values are known.
void finishVolume(VdbFile& file, const VdbFile::Entry& entry, const openvdb::GridBase& grid, Volume& volume);

}  // namespace freevoxels
