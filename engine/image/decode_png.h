#pragma once
// PNG files in memory.

#include <cstdint>
#include <span>
#include <string>

#include "engine/image/image.h"

namespace freevoxels {

/// The image that readPng reads of a file of these bytes. `name` is what sentences call it.
Image decodePng(const std::string& name, std::span<const std::uint8_t> file);

}  // namespace freevoxels
