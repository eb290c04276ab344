#pragma once
// Stacks of TIFF, written here byte by byte.

#include <array>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <string>

namespace freevoxels::test {

/// Pages of 16 bits, 4 x 3 pixels each, whose values are 100 times their number and that of the pixel.
struct TiffFixture {
  int pages = 1;
  std::string description;
  std::array<std::uint32_t, 2> resolution{1, 1};
  std::uint16_t unit = 1;  ///< 1 none, 2 inch, 3 centimetre
  int images = 1;          ///< in each page, behind each other, of which the page says the first
  std::uint16_t samples = 1;
  std::uint16_t photometric = 1;
  int firstPage = 0;
  glm::ivec2 size{4, 3};

  std::string valuesOf(int page) const {
    std::string values;
    for (int i = 0; i < size.x * size.y * samples; ++i) {
      const auto value = std::uint16_t(100 * (firstPage + page) + i);
      values.append(reinterpret_cast<const char*>(&value), 2);
    }
    return values;
  }

  std::string bytes() const {
    std::string file("II*\0\0\0\0\0", 8);
    std::size_t link = 4;
    for (int page = 0; page < pages; ++page) {
      const auto append = [&](auto value) { file.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
      const auto values = std::uint32_t(file.size());
      for (int image = 0; image < images; ++image) file += valuesOf(page * images + image);
      const auto fraction = std::uint32_t(file.size());
      append(resolution[0]);
      append(resolution[1]);
      const auto text = std::uint32_t(file.size());
      file += description + std::string(1 + (description.size() + 1) % 2, '\0');
      const auto here = std::uint32_t(file.size());
      std::memcpy(file.data() + link, &here, sizeof(here));
      const auto entry = [&](std::uint16_t tag, std::uint16_t type, std::uint32_t count, std::uint32_t value) {
        append(tag);
        append(type);
        append(count);
        append(value);
      };
      constexpr std::uint16_t kText = 2, kShort = 3, kLong = 4, kFraction = 5;
      const bool isDescribed = page == 0 && !description.empty();
      append(std::uint16_t(isDescribed ? 13 : 12));
      entry(256, kLong, 1, std::uint32_t(size.x));
      entry(257, kLong, 1, std::uint32_t(size.y));
      entry(258, kShort, 1, 16);
      entry(259, kShort, 1, 1);
      entry(262, kShort, 1, photometric);
      if (isDescribed) entry(270, kText, std::uint32_t(description.size() + 1), text);
      entry(273, kLong, 1, values);
      entry(277, kShort, 1, samples);
      entry(278, kLong, 1, std::uint32_t(size.y));
      entry(279, kLong, 1, std::uint32_t(2 * size.x * size.y * samples));
      entry(282, kFraction, 1, fraction);
      entry(283, kFraction, 1, fraction);
      entry(296, kShort, 1, unit);
      link = file.size();
      append(std::uint32_t(0));
    }
    return file;
  }
};

inline std::string omeXml(const std::string& attributes, const std::string& content) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?><OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\"><Image ID=\"Image:0\">"
         "<Pixels ID=\"Pixels:0\" Type=\"uint16\" SizeX=\"4\" SizeY=\"3\" " +
         attributes + ">" + content + "</Pixels></Image></OME>";
}

}  // namespace freevoxels::test
