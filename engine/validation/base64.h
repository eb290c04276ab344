#pragma once
// Bytes as text: RFC 4648, section 4, with padding.

#include <cstdint>
#include <span>
#include <string>

namespace freevoxels {

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace freevoxels
