#pragma once
// Stacks of TIFF, written here byte by byte.

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace freevoxels::test {

/// The metadata of ImageJ with a look-up table for each colour, from black to it, after a part of another kind; and the lengths of its
/// parts.
struct ImageJMetadata {
  std::string bytes;
  std::vector<std::uint32_t> counts;

  explicit ImageJMetadata(const std::vector<std::array<int, 3>>& colors, bool isBigEndian = false,
                          const std::vector<std::array<double, 2>>& ranges = {}) {
    const auto append = [&](std::uint32_t value) {
      for (int i = 0; i < 4; ++i) bytes += char(value >> (isBigEndian ? 24 - 8 * i : 8 * i));
    };
    for (const std::uint32_t value :
         {0x494a494au, 0x696e666fu, 1u, 0x72616e67u, std::uint32_t(!ranges.empty()), 0x6c757473u, std::uint32_t(colors.size())})
      append(value);
    bytes += "notes ";
    counts = {28, 6};
    for (const std::array<double, 2>& range : ranges)
      for (const double end : range) {
        const auto bits = std::bit_cast<std::uint64_t>(end);
        for (int i = 0; i < 8; ++i) bytes += char(bits >> (isBigEndian ? 56 - 8 * i : 8 * i));
      }
    if (!ranges.empty()) counts.push_back(std::uint32_t(16 * ranges.size()));
    for (const std::array<int, 3>& color : colors) {
      for (const int last : color)
        for (int i = 0; i < 256; ++i) bytes += char(i * last / 255);
      counts.push_back(768);
    }
  }
};

/// Pages of 16 bits, or 8, 4 x 3 pixels each, whose values are 100 times their number and that of the pixel.
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
  bool hasBytes = false;                                  ///< whether values have 8 bits
  bool isPlanar = false;                                  ///< whether `samples` are in strips of their own
  std::uint16_t extraSample = 0;  ///< what the fourth of 4 is: 1 an associated opacity, 2 an unassociated one, 0 unsaid
  std::optional<ImageJMetadata> metadata = std::nullopt;  ///< of the first page

  std::string valuesOf(int page) const {
    std::string values;
    const int pixels = size.x * size.y;
    for (int i = 0; i < pixels * samples; ++i) {
      const int number = isPlanar ? i % pixels * samples + i / pixels : i;
      const auto value = std::uint16_t(100 * (firstPage + page) + number);
      values.append(reinterpret_cast<const char*>(&value), hasBytes ? 1 : 2);
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
      const bool hasMetadata = page == 0 && metadata;
      const auto parts = std::uint32_t(file.size());
      if (hasMetadata) file += metadata->bytes;
      const auto counts = std::uint32_t(file.size());
      if (hasMetadata)
        for (const std::uint32_t count : metadata->counts) append(count);
      // Where the strips are, and how long they are, where there are several.
      const auto stripBytes = std::uint32_t((hasBytes ? 1 : 2) * size.x * size.y), strips = isPlanar ? std::uint32_t(samples) : 1u;
      const auto places = std::uint32_t(file.size());
      for (std::uint32_t i = 0; i < strips; ++i) append(values + i * stripBytes);
      const auto lengths = std::uint32_t(file.size());
      for (std::uint32_t i = 0; i < strips; ++i) append(stripBytes);
      const auto here = std::uint32_t(file.size());
      std::memcpy(file.data() + link, &here, sizeof(here));
      const auto entry = [&](std::uint16_t tag, std::uint16_t type, std::uint32_t count, std::uint32_t value) {
        append(tag);
        append(type);
        append(count);
        append(value);
      };
      constexpr std::uint16_t kByte = 1, kText = 2, kShort = 3, kLong = 4, kFraction = 5;
      const bool isDescribed = page == 0 && !description.empty();
      append(std::uint16_t(13 + (isDescribed ? 1 : 0) + (extraSample != 0 ? 1 : 0) + (hasMetadata ? 2 : 0)));
      entry(256, kLong, 1, std::uint32_t(size.x));
      entry(257, kLong, 1, std::uint32_t(size.y));
      entry(258, kShort, 1, hasBytes ? 8 : 16);
      entry(259, kShort, 1, 1);
      entry(262, kShort, 1, photometric);
      if (isDescribed) entry(270, kText, std::uint32_t(description.size() + 1), text);
      entry(273, kLong, strips, isPlanar ? places : values);
      entry(277, kShort, 1, samples);
      entry(278, kLong, 1, std::uint32_t(size.y));
      entry(279, kLong, strips, isPlanar ? lengths : samples * stripBytes);
      entry(282, kFraction, 1, fraction);
      entry(283, kFraction, 1, fraction);
      entry(284, kShort, 1, isPlanar ? 2 : 1);
      entry(296, kShort, 1, unit);
      if (extraSample != 0) entry(338, kShort, 1, extraSample);
      if (hasMetadata) {
        entry(50838, kLong, std::uint32_t(metadata->counts.size()), counts);
        entry(50839, kByte, std::uint32_t(metadata->bytes.size()), parts);
      }
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
