#pragma once
// Writes a baked volume chunk by chunk: at no time more than a few chunks are in memory.

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "engine/storage/chunk_pyramid.h"
#include "engine/storage/fvx_description.h"
#include "engine/volume/subject.h"

namespace freevoxels::fvx {

struct WriteSettings {
  glm::ivec3 dimensions{0};
  Encodings encodings;
  WithoutData withoutData = WithoutData::Zero;  ///< of scalars, in means
  bool leaveOutZeros = false;  ///< bricks of scalars of which none is above 0, as well as those without data
  bool compress = false;
};

/// Failures to write are std::system_error: to be used within writeAtomically (core/atomic_file.h).
class FvxWriter {
 public:
  /// Chunks are spooled to temporary files without names in `folder`, one for each level and channel, as their number is known at
  /// the end only and coarse levels come first in the file.
  FvxWriter(const std::filesystem::path& folder, const WriteSettings& settings);
  ~FvxWriter();

  /// The next chunks of level 0, in Hilbert order (hilbert.h); those without data may be left out.
  void add(std::span<const ChunkValues> chunks);
  /// Of the chunks of level 0 so far; ranges of channels without active voxels are 0.
  struct Summary {
    std::uint64_t activeVoxels = 0;
    float minimum = 0.0f, maximum = 0.0f;
  };
  Summary summary(Channel channel) const;
  /// Writes the file. `provenance` is JSON, for people.
  void finish(const std::filesystem::path& file, const Description& description, const ContentCells& content,
              const std::string& provenance);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace freevoxels::fvx
