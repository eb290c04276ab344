#pragma once
// Writing and reading volumes in baked files: Subr et al. 2007, Section 5.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "engine/core/stages.h"
#include "engine/storage/chunk_pyramid.h"
#include "engine/storage/fvx_file.h"
#include "engine/volume/vdb_parts.h"
#include "engine/volume/volume.h"

namespace freevoxels {

struct BakeSettings {
  /// Whether values are stored as 32-bit floats, so that every classification is as exact as with the
  /// original volume. Otherwise they take 16 bits each, as exact as the renderer's own for the one
  /// classification: halves of densities in units of optical depth, and equally spaced numbers of scalars
  /// over the transfer function's range.
  bool keepScalars = false;
  bool compress = false;  ///< whether each chunk is compressed with Zstandard
  std::string provenance = "{}";  ///< JSON for readers of the file
};

/// The processes that bake a volume together; by default this one alone. All of them have the volume. Stretches of chunks are dealt to
/// them in turn, and the first one writes the file, which has the same bytes for any number.
struct BakeTeam {
  int index = 0, count = 1;
  /// Moves the bytes from process `from` to the first one; called by these two, with the same sequence of calls on both.
  std::function<void(std::vector<std::byte>& bytes, int from)> bring = {};
};

/// The values of a chunk of the finest level; called by several threads.
using ChunkSource = std::function<fvx::ChunkValues(glm::ivec3 cell)>;

/// Writes a volume that need not fit into memory: each of `cells` is requested once, in Hilbert order, a few at a
/// time. `outline` is the volume without values; its counts and ranges are computed on the way. `content` is
/// the visible part, and `range` the least and the greatest scalar that a transfer function distinguishes.
/// Atomic (core/atomic_file.h).
struct StreamedVolume {
  Volume outline;
  ContentCells content;
  glm::vec2 range{0.0f};
  std::vector<glm::ivec3> cells;  ///< of all chunks that may hold something, in any order
  ChunkSource chunk;
};
/// The volume of a file that is read part by part; `parts` must outlive the result.
StreamedVolume partsStream(const VdbParts& parts, const Classification& classification);
void bakeStreamed(const std::filesystem::path& file, const StreamedVolume& volume, const Classification& classification,
                  const BakeSettings& settings, const Progress& progress = {}, const BakeTeam& team = {});

/// Stage of Progress from which on the file exists under a temporary name: whoever ends the program before leaves nothing behind.
inline constexpr std::string_view kWritingStage = "writing the file";

/// Writes the volume, its coarser levels and its classification. Atomic (core/atomic_file.h).
void bakeVolume(const std::filesystem::path& file, const Volume& volume, const Classification& classification,
                const BakeSettings& settings, const Progress& progress = {}, const BakeTeam& team = {});

/// Reads a level of a baked file: the voxels, or for a level above 0 blocks of 2^level voxels along each
/// axis, each their mean, at the same place in the world. Every chunk that is read is verified first, and the file is not needed
/// afterwards. `progress` may abandon it. Fails with ErrorKind::Input if a chunk is damaged.
Volume readBaked(const std::shared_ptr<const fvx::FvxFile>& file, int level = 0, const Progress& progress = {});

/// Returns what readBaked does without the values, before any chunk is read.
Volume bakedOutline(const fvx::FvxFile& file, int level = 0);

/// The finest level whose box, or whose bricks, have at most `maximumVoxels` voxels. Fails with ErrorKind::OutOfMemory if there
/// is none.
int finestLevel(const fvx::FvxFile& file, std::uint64_t maximumVoxels);

}  // namespace freevoxels
