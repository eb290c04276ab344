#include "engine/storage/plane_codec.h"

#include <zstd.h>

#include <stdexcept>

namespace freevoxels::fvx {

namespace {

constexpr int kZstdLevel = 3;

}  // namespace

Codec compressPlanes(std::size_t bytesPerValue, std::vector<std::byte>& bytes) {
  std::vector<std::byte> planes(bytes.size());
  const std::size_t values = bytes.size() / bytesPerValue;
  for (std::size_t plane = 0; plane < bytesPerValue; ++plane)
    for (std::size_t i = 0; i < values; ++i) planes[plane * values + i] = bytes[i * bytesPerValue + plane];
  std::vector<std::byte> packed(ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), planes.data(), planes.size(), kZstdLevel);
  if (ZSTD_isError(size)) throw std::runtime_error(ZSTD_getErrorName(size));
  if (size >= bytes.size()) return Codec::None;
  packed.resize(size);
  bytes = std::move(packed);
  return Codec::PlanesZstd;
}

bool decompressPlanes(std::span<const std::byte> stored, std::size_t bytesPerValue, std::vector<std::byte>& planes, std::span<std::byte> bytes) {
  planes.resize(bytes.size());
  if (ZSTD_decompress(planes.data(), planes.size(), stored.data(), stored.size()) != planes.size()) return false;
  const std::size_t values = planes.size() / bytesPerValue;
  for (std::size_t plane = 0; plane < bytesPerValue; ++plane)
    for (std::size_t i = 0; i < values; ++i) bytes[i * bytesPerValue + plane] = planes[plane * values + i];
  return true;
}

}  // namespace freevoxels::fvx
