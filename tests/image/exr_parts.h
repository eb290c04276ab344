#pragma once
// What tests of OpenEXR files have in common: headers and slices of small images, and attributes in the bytes of a file.

#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace freevoxels::test {

/// The place of an attribute's value in the bytes of a file.
inline std::size_t placeOf(const std::string& bytes, const std::string& name, const std::string& type) {
  const std::string start = name + '\0' + type + '\0';
  const std::size_t at = bytes.find(start);
  EXPECT_NE(at, std::string::npos) << name;
  return at + start.size() + sizeof(std::uint32_t);
}

template <typename Value>
std::string patched(std::string bytes, const std::string& name, const std::string& type, const Value& value) {
  std::memcpy(&bytes[placeOf(bytes, name, type)], &value, sizeof(value));
  return bytes;
}

using Window = std::array<std::int32_t, 4>;

template <typename T>
Imf::FrameBuffer frameOf(const std::vector<T>& values, glm::ivec2 size, Imf::PixelType type) {
  Imf::FrameBuffer frame;
  for (const char* name : {"R", "G", "B", "A"})
    frame.insert(name, Imf::Slice(type, reinterpret_cast<char*>(const_cast<T*>(values.data())), sizeof(T), sizeof(T) * std::size_t(size.x)));
  return frame;
}

inline Imf::Header headerOf(glm::ivec2 size, Imf::PixelType type, int compression) {
  Imf::Header header(size.x, size.y);
  header.compression() = Imf::Compression(compression);
  for (const char* name : {"R", "G", "B", "A"}) header.channels().insert(name, Imf::Channel(type));
  return header;
}

}  // namespace freevoxels::test
