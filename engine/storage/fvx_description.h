#pragma once
// The description section of a baked volume: everything that a reader needs but the chunks, as JSON.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "engine/storage/fvx_encoding.h"
#include "engine/storage/fvx_format.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels::fvx {

/// The encoding of each Channel. A channel without a value is not in the file; the scalars always are.
using Encodings = std::array<std::optional<Encoding>, kChannels>;

/// Number of values of a voxel in a channel: three for albedos, otherwise one.
inline constexpr int valuesPerVoxel(Channel channel) {
  return channel == Channel::Albedo ? 3 : 1;
}

struct Description {
  Volume volume;  ///< the volume without bricks
  Encodings encodings;

  std::size_t brickBytes(Channel channel) const {
    return std::size_t(kBrickVoxels) * std::size_t(valuesPerVoxel(channel)) *
           encodings[std::size_t(channel)]->bytesPerValue();
  }
  /// The range in which all stored values of a level are.
  glm::vec2 valueRange(Channel channel, int level) const;
  /// The number of voxels of level 0 that have a value, at most.
  std::uint64_t activeVoxels(Channel channel) const;
};

std::string toJson(const Description& description);
/// Parses a description. Fails with ErrorKind::Input, naming `file`, if something is missing or impossible. Texts in it are made printable.
Description parseDescription(std::string_view json, const std::filesystem::path& file);

}  // namespace freevoxels::fvx
