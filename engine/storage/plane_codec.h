#pragma once
// Codec::PlanesZstd: the bytes of values are dealt to planes, first the lowest bytes of all values, and the planes are compressed.

#include <cstddef>
#include <span>
#include <vector>

#include "engine/storage/fvx_format.h"

namespace freevoxels::fvx {

/// Compresses `bytes` in place, unless that makes them no fewer.
Codec compressPlanes(std::size_t bytesPerValue, std::vector<std::byte>& bytes);
/// `bytes` has the size of the result, and `planes` is memory that is used on the way. Returns false if `stored` are not as many bytes
/// compressed.
bool decompressPlanes(std::span<const std::byte> stored, std::size_t bytesPerValue, std::vector<std::byte>& planes, std::span<std::byte> bytes);

}  // namespace freevoxels::fvx
