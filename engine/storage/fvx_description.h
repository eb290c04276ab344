#pragma once
// The description section of a baked volume: everything that a reader needs but the chunks, as JSON.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/storage/fvx_encoding.h"
#include "engine/storage/fvx_format.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels::fvx {

/// The encoding of each Channel. A channel without a value is not in the file; the scalars always are.
using Encodings = std::array<std::optional<Encoding>, kChannels>;

struct Description {
  Volume volume;  ///< the volume without bricks
  Encodings encodings;

  /// Three for albedos, four for light (its amount and its colour), otherwise one.
  std::size_t valuesPerVoxel(Channel channel) const {
    if (channel == Channel::Albedo) return 3;
    return channel == Channel::Temperature && volume.temperature->isRadiance ? 4 : 1;
  }
  std::size_t brickBytes(Channel channel) const {
    return kBrickVoxels * valuesPerVoxel(channel) * encodings[std::size_t(channel)]->bytesPerValue();
  }
  /// The range in which all stored values of a level are.
  glm::vec2 valueRange(Channel channel, int level) const;
  /// The number of voxels of level 0 that have a value, at most.
  std::uint64_t activeVoxels(Channel channel) const;
};

/// Calls `apply(channel, grids)` with the channels that a volume has, and pointers to the grids of each, in the order of a voxel's values.
template <typename MaybeConstVolume, typename Apply>
void forEachChannel(MaybeConstVolume& volume, const Apply& apply) {
  using Grids = std::vector<decltype(&volume.scalars)>;
  apply(Channel::Scalars, Grids{&volume.scalars});
  if (volume.temperature) {
    auto& [red, green, blue] = volume.temperature->colors;
    apply(Channel::Temperature,
          volume.temperature->isRadiance ? Grids{&volume.temperature->values, &red, &green, &blue} : Grids{&volume.temperature->values});
  }
  if (volume.albedo) apply(Channel::Albedo, Grids{&volume.albedo->values[0], &volume.albedo->values[1], &volume.albedo->values[2]});
}

std::string toJson(const Description& description);
/// Parses a description. Fails with ErrorKind::Input, naming `file`, if something is missing or impossible. Texts in it are made printable.
Description parseDescription(std::string_view json, const std::filesystem::path& file);

}  // namespace freevoxels::fvx
