#pragma once
// Writes a baked volume chunk by chunk, with only a few chunks in memory at any time.

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "engine/core/stages.h"
#include "engine/storage/chunk_encoder.h"
#include "engine/volume/subject.h"

namespace freevoxels::fvx {

/// Throws std::system_error if it cannot write: to be used within writeAtomically (core/atomic_file.h). Calls: add() any number of times,
/// then summary(), then finish() once.
class FvxWriter {
 public:
  /// Chunks are spooled to unnamed temporary files in `folder`, one for each level and channel, because their
  /// number is known only at the end and coarse levels come first in the file.
  FvxWriter(const std::filesystem::path& folder, const WriteSettings& settings);
  ~FvxWriter();

  /// Adds the next chunks of level 0, which encodeChunks made with the same settings. All chunks come in Hilbert order (hilbert.h);
  /// those without data may be left out.
  void add(std::span<const std::byte> encoded);
  /// Counts and ranges of the chunks of level 0 so far; ranges of channels without active voxels are 0.
  struct Summary {
    std::uint64_t activeVoxels = 0;
    float minimum = 0.0f, maximum = 0.0f;
  };
  Summary summary(Channel channel) const;
  /// Writes the file. `provenance` is JSON for readers of the file; `description.volume.classification` must not be null.
  void finish(const std::filesystem::path& file, const Description& description, const ContentCells& content,
              const std::string& provenance);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace freevoxels::fvx
