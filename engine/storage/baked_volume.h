#pragma once
// Volumes in baked files and out of them: Subr et al. 2007, Section 5.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "engine/core/stages.h"
#include "engine/storage/chunk_pyramid.h"
#include "engine/storage/fvx_file.h"
#include "engine/volume/volume.h"

namespace freevoxels {

struct BakeSettings {
  /// Values as 32-bit floats, so that every classification is as exact as of the volume itself. Else 16 bits a value, as exact as the
  /// renderer's own for the one classification: halves of densities in units of optical depth, equally spaced numbers of scalars over
  /// the transfer function's range.
  bool keepScalars = false;
  bool compress = false;  ///< each chunk with Zstandard
  std::string provenance = "{}";  ///< JSON, for people
};

/// The values of a chunk of the finest level; called by several threads.
using ChunkSource = std::function<fvx::ChunkValues(glm::ivec3 cell)>;

/// Writes a volume that need not fit into memory: its chunks are asked for once each, in Hilbert order, a few at a time. `outline` is
/// the volume without values; its counts and ranges are found on the way. `content` is what is seen of it, and `range` the least and
/// the greatest scalar as far as a transfer function is to tell them apart. Atomic (core/atomic_file.h).
struct StreamedVolume {
  Volume outline;
  ContentCells content;
  glm::vec2 range{0.0f};
  ChunkSource chunk;
};
void bakeStreamed(const std::filesystem::path& file, const StreamedVolume& volume, const Classification& classification,
                  const BakeSettings& settings, const Progress& progress = {});

/// Writes the volume, its coarser levels and its classification. Atomic (core/atomic_file.h).
void bakeVolume(const std::filesystem::path& file, const Volume& volume, const Classification& classification,
                const BakeSettings& settings, const Progress& progress = {});

/// The volume of a level of a baked file: the voxels, or of a level above 0 blocks of 2^level voxels along each axis, each their mean,
/// in the same place of the world. Every chunk that is read is checked first. Values that are stored as floats and not compressed are
/// used in place, and keep the file mapped. Fails with ExitCode::Input where a chunk is damaged.
Volume readBaked(const std::shared_ptr<const fvx::FvxFile>& file, int level = 0);

/// readBaked without the values: what is known of the volume before any chunk is read.
Volume bakedOutline(const fvx::FvxFile& file, int level = 0);

/// The finest level whose box has no more than `maximumVoxels` voxels. Fails with ExitCode::OutOfMemory where none has.
int finestLevel(const fvx::FvxFile& file, std::uint64_t maximumVoxels);

}  // namespace freevoxels
