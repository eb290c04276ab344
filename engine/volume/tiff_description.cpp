// By https://imagej.net/ij/developer/source/ij/io/TiffEncoder.java.html (TiffEncoder and FileInfo) and
// https://docs.openmicroscopy.org/ome-model/latest/ome-tiff/specification.html.
#include "engine/volume/tiff_description.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "engine/image/srgb.h"
#include "engine/volume/length_unit.h"
#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

constexpr int kMaxOfAxis = 1 << 20;
constexpr std::uint64_t kMostPlanes = std::uint64_t(1) << 24;

/// The number that a text is; nothing for other texts.
template <typename Number>
std::optional<Number> numberIn(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

std::optional<double> distanceIn(std::string_view text) {
  const std::optional<double> number = numberIn<double>(text);
  return number && std::isfinite(*number) && *number != 0.0 ? std::optional(std::abs(*number)) : std::nullopt;
}

int countIn(const std::filesystem::path& file, std::string_view text, std::string_view name) {
  if (text.empty()) return 1;
  const std::optional<int> count = numberIn<int>(text);
  if (!count || *count < 1 || *count > kMaxOfAxis) failDamaged(file, fmt::format("its description says {} '{}'", name, text.substr(0, 40)));
  return *count;
}

void checkPlanes(const std::filesystem::path& file, const TiffDescription& description) {
  if (description.planes() > kMostPlanes) failDamaged(file, fmt::format("its description says {} planes", description.planes()));
}

std::string_view attribute(const pugi::xml_node& node, const char* name) {
  return node.attribute(name).as_string();
}

/// The linear colour of a number in OME-XML, which has 8 bits each of red, green, blue and alpha, from the highest.
std::optional<glm::vec3> omeColor(std::string_view text) {
  const std::optional<std::int64_t> number = numberIn<std::int64_t>(text);
  if (!number) return std::nullopt;
  const auto linear = [&](int shift) { return linearFromSrgb(float(std::uint32_t(*number) >> shift & 255u) / 255.0f); };
  return glm::vec3(linear(24), linear(16), linear(8));
}

/// A number of ImageJ's metadata, in either order of bytes.
std::uint32_t imageJNumber(std::span<const std::byte> bytes, bool isBigEndian) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number |= std::uint32_t(bytes[isBigEndian ? 3 - i : i]) << (8 * i);
  return number;
}

/// The colour of the largest value in a table of 256 values each of red, green and blue; none for black.
std::optional<glm::vec3> lastColor(std::span<const std::byte> table) {
  glm::vec3 color;
  for (std::size_t c = 0; c < 3; ++c) color[int(c)] = linearFromSrgb(float(std::uint8_t(table[256 * c + 255])) / 255.0f);
  return color == glm::vec3(0.0f) ? std::nullopt : std::optional(color);
}

/// A display range of two doubles; none where it is no range of numbers.
std::optional<std::array<float, 2>> windowOf(std::span<const std::byte> range, bool isBigEndian) {
  const auto numberAt = [&](std::size_t first) {
    const std::uint64_t low = imageJNumber(range.subspan(first + (isBigEndian ? 4 : 0)), isBigEndian);
    const std::uint64_t high = imageJNumber(range.subspan(first + (isBigEndian ? 0 : 4)), isBigEndian);
    return float(std::bit_cast<double>(high << 32 | low));
  };
  const std::array window{numberAt(0), numberAt(sizeof(double))};
  const bool isRange = std::isfinite(window[0]) && std::isfinite(window[1]) && window[0] < window[1];
  return isRange ? std::optional(window) : std::nullopt;
}

void takeOmeChannels(const pugi::xml_node& pixels, TiffDescription& description) {
  std::vector<ScanChannel> channels;
  std::set<std::string> colors;
  for (const pugi::xml_node& node : pixels.children("Channel")) {
    channels.push_back({.name = std::string(attribute(node, "Name")), .color = omeColor(attribute(node, "Color"))});
    colors.insert(std::string(attribute(node, "Color")));
  }
  if (channels.size() != std::size_t(description.channels)) return;
  if (channels.size() > 1 && colors.size() == 1)
    for (ScanChannel& channel : channels) channel.color.reset();  // a colour that all have is that of programs which know none
  description.described = std::move(channels);
}

/// The pages of planes, where the description lists them.
void takeOmePages(const std::filesystem::path& file, const pugi::xml_node& pixels, TiffDescription& description) {
  std::set<std::string> files;
  std::vector<int> pages(description.planes(), -1);
  bool isListed = false;
  for (const pugi::xml_node& data : pixels.children("TiffData")) {
    if (const auto name = attribute(data.child("UUID"), "FileName"); !name.empty()) files.insert(std::string(name));
    isListed |= data.attribute("IFD") || data.attribute("FirstC") || data.attribute("FirstZ") || data.attribute("FirstT");
    const auto first = [&](const char* axis) { return std::max(data.attribute(axis).as_int(), 0); };
    const int c = first("FirstC"), z = first("FirstZ"), t = first("FirstT"), page = first("IFD");
    if (c >= description.channels || z >= description.slices || t >= description.frames)
      failDamaged(file, "its description has a plane beyond its sizes");
    const std::uint64_t begin = description.planeAt(c, z, t), left = description.planes() - begin;
    const std::uint64_t count = data.attribute("PlaneCount") ? std::uint64_t(std::max(data.attribute("PlaneCount").as_int(), 0))
                                : data.attribute("IFD")      ? 1
                                                             : left;
    for (std::uint64_t i = 0; i < std::min(count, left); ++i) pages[begin + i] = page + int(i);
  }
  if (files.size() > 1)
    fail(ErrorKind::Input, "the planes of '{}' are in {} files, and those of one file are read: write them into one", file.string(),
         files.size());
  if (isListed) description.pages = std::move(pages);
}

}  // namespace

std::uint64_t TiffDescription::planeAt(int channel, int slice, int frame) const {
  std::uint64_t plane = 0, stride = 1;
  for (const char axis : order) {
    const int place = axis == 'C' ? channel : axis == 'Z' ? slice : frame;
    plane += stride * std::uint64_t(place);
    stride *= std::uint64_t(axis == 'C' ? channels : axis == 'Z' ? slices : frames);
  }
  return plane;
}

std::optional<TiffDescription> imageJDescription(const std::filesystem::path& file, const std::string& text) {
  if (!text.starts_with("ImageJ=")) return std::nullopt;
  std::map<std::string, std::string> values;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t sign = line.find('=');
    if (sign != std::string::npos) values[line.substr(0, sign)] = line.substr(sign + 1);
  }
  TiffDescription description{.format = "TIFF of ImageJ"};
  const int images = countIn(file, values["images"], "images");
  description.channels = countIn(file, values["channels"], "channels");
  description.frames = countIn(file, values["frames"], "frames");
  description.slices = countIn(file, values["slices"], "slices");
  if (description.planes() == 1) description.slices = images;  // a stack that is no hyperstack
  checkPlanes(file, description);
  if (description.planes() != std::uint64_t(images))
    failDamaged(file, fmt::format("its description says {} images, and {} channels of {} slices and {} frames", images,
                                  description.channels, description.slices, description.frames));
  description.unit = millimetresOf(values["unit"]);
  description.isInMillimetres = description.unit.has_value();
  if (const std::optional<double> spacing = distanceIn(values["spacing"]))
    description.distance[2] = *spacing * description.unit.value_or(1.0);
  return description;
}

void takeImageJLooks(std::span<const std::byte> metadata, std::span<const std::uint32_t> counts, TiffDescription& description) {
  constexpr std::uint32_t kMagic = 0x494a494a, kTables = 0x6c757473, kRanges = 0x72616e67;  // IJIJ, luts, rang
  constexpr std::size_t kEntry = 8, kTable = 3 * 256, kRange = 2 * sizeof(double);
  if (counts.empty() || counts[0] < 4 || counts[0] > metadata.size()) return;
  const bool isBigEndian = imageJNumber(metadata, true) == kMagic;
  if (!isBigEndian && imageJNumber(metadata, false) != kMagic) return;
  const std::span<const std::byte> header = metadata.first(counts[0]);
  const auto channels = std::size_t(description.channels);
  std::vector<std::optional<glm::vec3>> colors;
  std::vector<std::optional<std::array<float, 2>>> windows;
  std::size_t part = 1, at = counts[0];
  for (std::size_t entry = 4; entry + kEntry <= header.size(); entry += kEntry) {
    const std::uint32_t type = imageJNumber(header.subspan(entry), isBigEndian);
    for (std::uint32_t n = imageJNumber(header.subspan(entry + 4), isBigEndian); n > 0; --n, ++part) {
      if (part >= counts.size() || counts[part] > metadata.size() - at) return;
      const std::span<const std::byte> bytes = metadata.subspan(at, counts[part]);
      if (type == kTables && bytes.size() == kTable) colors.push_back(lastColor(bytes));
      if (type == kRanges && bytes.size() == channels * kRange)
        for (std::size_t c = 0; c < channels; ++c) windows.push_back(windowOf(bytes.subspan(c * kRange, kRange), isBigEndian));
      at += bytes.size();
    }
  }
  // A colour that all have is that of programs which know none.
  const bool areSame = std::ranges::all_of(colors, [&](const auto& color) { return color == colors.front(); });
  if (colors.size() != channels || areSame) colors.clear();
  if (windows.size() != channels) windows.clear();
  if (description.described.empty() && !(colors.empty() && windows.empty())) description.described.resize(channels);
  for (std::size_t i = 0; i < colors.size(); ++i) description.described[i].color = colors[i];
  for (std::size_t i = 0; i < windows.size(); ++i) description.described[i].window = windows[i];
}

std::optional<TiffDescription> omeDescription(const std::filesystem::path& file, const std::string& text, int components) {
  if (text.find("<OME") == std::string::npos) return std::nullopt;
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size())) failDamaged(file, "its description of OME is no XML");
  const pugi::xml_node pixels = document.child("OME").child("Image").child("Pixels");
  if (!pixels) fail(ErrorKind::Input, "the description of '{}' has no pixels: name the file that has them", file.string());
  TiffDescription description{.format = "OME-TIFF"};
  description.channels = countIn(file, attribute(pixels, "SizeC"), "SizeC");
  if (description.channels % components == 0) description.channels /= components;
  description.slices = countIn(file, attribute(pixels, "SizeZ"), "SizeZ");
  description.frames = countIn(file, attribute(pixels, "SizeT"), "SizeT");
  checkPlanes(file, description);
  const std::string_view order = attribute(pixels, "DimensionOrder");
  description.order = order.starts_with("XY") ? std::string(order.substr(2)) : "CZT";
  std::string sorted = description.order;
  std::ranges::sort(sorted);
  if (sorted != "CTZ") failDamaged(file, "its DimensionOrder is none");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name = std::string("PhysicalSize") + "XYZ"[axis];
    const std::optional<double> size = distanceIn(attribute(pixels, name.c_str()));
    const pugi::xml_attribute unit = pixels.attribute((name + "Unit").c_str());
    const std::optional<double> length = millimetresOf(unit ? unit.as_string() : "\u00b5m");
    if (size) description.distance[axis] = *size * length.value_or(1.0);
    description.isInMillimetres |= size && length;
  }
  takeOmeChannels(pixels, description);
  takeOmePages(file, pixels, description);
  return description;
}

}  // namespace freevoxels
