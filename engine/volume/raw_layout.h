#pragma once
// What the values of a file without a header are.

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "engine/volume/sample_type.h"

namespace freevoxels {

struct RawLayout {
  glm::ivec3 dimensions{0};  ///< along x, y and z; x is fastest in the file
  SampleType type = SampleType::U8;
  bool isBigEndian = false;
  std::uint64_t headerBytes = 0;  ///< in front of the values, which are skipped

  bool operator==(const RawLayout&) const = default;
};

/// "256x256x128,u16[,big|little][,header=BYTES]". Fails with ErrorKind::Usage; `name` is what the sentence calls the text.
RawLayout readRawLayout(const std::string& name, const std::string& text);
std::string rawLayoutText(const RawLayout& layout);

/// The layout that a file name says as those of the Open Scientific Visualization Datasets do: NAME_256x256x128_uint16.raw, little-endian.
std::optional<RawLayout> layoutOfName(const std::filesystem::path& file);

}  // namespace freevoxels
