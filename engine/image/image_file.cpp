#include <array>
#include <fstream>
#include <string_view>
#include <type_traits>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/image/image.h"

namespace freevoxels {

Image cropped(const Image& image, const PixelRectangle& part) {
  FV_CHECK_EQ(glm::all(glm::greaterThanEqual(part.corner, glm::ivec2(0))) && glm::all(glm::greaterThan(part.size, glm::ivec2(0))) &&
                  glm::all(glm::lessThanEqual(part.corner + part.size, image.size)),
              true);
  const auto partOf = [&](const auto& values) {
    std::remove_cvref_t<decltype(values)> result;
    if (values.empty()) return result;
    result.reserve(std::size_t(part.size.x) * std::size_t(part.size.y));
    for (int row = 0; row < part.size.y; ++row) {
      const auto first = values.begin() + std::ptrdiff_t(part.corner.y + row) * image.size.x + part.corner.x;
      result.insert(result.end(), first, first + part.size.x);
    }
    return result;
  };
  Image result{.size = part.size, .pixels = partOf(image.pixels), .depth = partOf(image.depth)};
  for (const auto& [name, values] : image.channels) result.channels[name] = partOf(values);
  result.wholeSize = image.size;
  result.offset = part.corner;
  return result;
}

Image readImage(const std::filesystem::path& file) {
  constexpr std::string_view kPng = "\x89PNG", kExr = "\x76\x2f\x31\x01";
  checkInputFile("image", file);
  std::array<char, 4> start{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), start.size());
  if (!stream.is_open() || stream.bad())
    fail(ErrorKind::Input, "cannot read '{}': it cannot be opened; check its permissions", file.string());
  const std::string_view signature(start.data(), start.size());
  if (signature == kExr) return readExr(file);
  if (signature == kPng) return readPng(file);
  if (isHdr(file)) return readHdr(file);
  fail(ErrorKind::Input, "cannot read '{}': it is neither an OpenEXR nor a PNG image, nor a Radiance picture; choose one that is",
       file.string());
}

}  // namespace freevoxels
