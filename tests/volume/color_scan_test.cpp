// Scans of colours, in every format that has them.

#include <gtest/gtest.h>

#include "engine/core/parameter.h"
#include "engine/image/srgb.h"
#include "engine/volume/colors.h"
#include "engine/volume/scan_file.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"
#include "tests/volume/scan_fixture.h"

namespace freevoxels::test {
namespace {

namespace color_fs = std::filesystem;

ScanPlace colorPlace() {
  return placeAlong("LPS", {11, 5, 3}, {2.0, 3.0, 2.5});
}

/// The number of a component of the voxel at a place among all.
std::uint8_t numberAt(int voxel, int component) {
  return std::uint8_t((7 * voxel + 60 * component + 5) % 256);
}

/// The numbers of all voxels, those of a voxel one after the other.
std::string colorBytes(int first, int voxels, int components) {
  std::string bytes;
  for (int i = first; i < first + voxels; ++i)
    for (int c = 0; c < components; ++c) bytes += char(numberAt(i, c));
  return bytes;
}

std::string replaced(std::string text, const std::string& old, const std::string& now) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(std::min(at, text.size()), old.size(), now);
}

Volume readColors(const color_fs::path& file, ScanRequest request = {}) {
  request.maximumVoxels = std::uint64_t(1) << 40;
  return readScan(file, request);
}

void expectColors(const color_fs::path& file, bool hasOpacity = false) {
  SCOPED_TRACE(file.filename().string());
  testing::internal::CaptureStderr();
  const Volume volume = readColors(file);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  const ScanPlace place = colorPlace();
  ASSERT_EQ(volume.dimensions, place.size);
  ASSERT_TRUE(volume.albedo);
  EXPECT_EQ(volume.albedo->name, kColorsName);
  EXPECT_EQ(volume.up, glm::dvec3(0.0, 0.0, 1.0));
  for (int i = 0; i < place.size.x * place.size.y * place.size.z; ++i) {
    const glm::ivec3 at(i % place.size.x, i / place.size.x % place.size.y, i / place.size.x / place.size.y);
    glm::vec3 color;
    for (int c = 0; c < 3; ++c) color[c] = linearFromSrgb(float(numberAt(i, c)) / 255.0f);
    for (int c = 0; c < 3; ++c) ASSERT_EQ(volume.albedo->values[std::size_t(c)].at(at), color[c]) << i;
    const float luminance = srgbFromLinear(glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f)));
    const float density = hasOpacity ? float(numberAt(i, 3)) / 255.0f : luminance;
    if (density == 0.0f)
      EXPECT_EQ(volume.scalar(at.x, at.y, at.z), kInactiveVoxel);
    else
      ASSERT_NEAR(volume.scalar(at.x, at.y, at.z), density, 1e-5f) << i;
  }
}

std::string nrrdOfColors(int components, const std::string& type = "uint8") {
  const ScanPlace place = colorPlace();
  std::string header = nrrdHeader(place, "endian: little\nencoding: raw\n\n");
  header = replaced(header, "type: uint16\ndimension: 3", "type: " + type + "\ndimension: 4");
  header = replaced(header, "sizes: ", "sizes: " + std::to_string(components) + " ");
  header = replaced(header, "directions:", "directions: none");
  return replaced(header, "kinds: ", "kinds: " + std::string(components == 4 ? "RGBA-color " : components == 3 ? "RGB-color " : "vector "));
}

std::string dicomOfColors(int k, bool isPlanar) {
  const ScanPlace place = colorPlace();
  const int voxels = place.size.x * place.size.y;
  std::string pixels = colorBytes(k * voxels, voxels, 3), planes;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < voxels; ++i) planes += pixels[std::size_t(3 * i + c)];
  if (isPlanar) pixels = planes;
  if (pixels.size() % 2 != 0) pixels += '\0';
  std::string file = dicomOf(place, k);
  file.resize(file.find(std::string("\xe0\x7f\x10\0OW", 6)));
  const auto number = [](std::uint16_t element, int value) {
    return std::string("\x28\0", 2) + char(element & 255) + char(element >> 8) + std::string("US\x02\0", 4) + char(value) + '\0';
  };
  file = replaced(file, number(2, 1), number(2, 3));
  file = replaced(file, "CS\x0c" + std::string(1, '\0') + "MONOCHROME2 ",
                  std::string("CS\x04\0RGB ", 8) + number(6, isPlanar ? 1 : 0));
  for (const auto& [element, value] : {std::pair(0x100, 8), {0x101, 8}, {0x102, 7}})
    file = replaced(file, number(std::uint16_t(element), 2 * value + (value == 7 ? 1 : 0)), number(std::uint16_t(element), value));
  file = replaced(file, "-1024 ", "0     ");
  DicomElements values;
  values.words(0x7fe0, 0x10, pixels);
  return file + values.bytes();
}

TEST(ColorScan, EveryFormatOfColours) {
  const TemporaryFolder folder;
  const ScanPlace place = colorPlace();
  const int voxels = place.size.x * place.size.y * place.size.z;
  for (const int components : {3, 4}) {
    const std::string bytes = colorBytes(0, voxels, components), count = std::to_string(components);
    writeBytes(folder / (count + ".nrrd"), nrrdOfColors(components) + bytes);
    std::string meta = metaHeader(place, "MET_UCHAR", "LOCAL");
    meta = replaced(meta, "ElementType", "ElementNumberOfChannels = " + count + "\nElementType");
    writeBytes(folder / (count + ".mha"), meta + bytes);
    std::string nifti = niftiOf(place).substr(0, 352);
    put(nifti, 70, std::int16_t(components == 3 ? 128 : 2304));
    put(nifti, 72, std::int16_t(8 * components));
    writeBytes(folder / (count + ".nii"), nifti + bytes);
    std::string text;
    for (const char c : bytes) text += std::to_string(std::uint8_t(c)) + " ";
    std::string vti = vtiOf(place, "NumberOfComponents=\"" + count + "\" format=\"ascii\">" + text);
    writeBytes(folder / (count + ".vti"), replaced(vti, "UInt16", "UInt8"));
    for (const char* ending : {".nrrd", ".mha", ".nii", ".vti"}) expectColors(folder / (count + ending), components == 4);
  }
  for (const bool isPlanar : {false, true}) {
    const color_fs::path series = folder / (isPlanar ? "planes" : "pixels");
    color_fs::create_directories(series);
    for (int k = 0; k < place.size.z; ++k) writeBytes(series / (std::to_string(k) + ".dcm"), dicomOfColors(k, isPlanar));
    expectColors(series);
  }
}

TEST(ColorScan, TheirComponentsAreChannels) {
  const TemporaryFolder folder;
  writeBytes(folder / "a.nrrd", nrrdOfColors(3) + colorBytes(0, 165, 3));
  const ScanHeader header = readScanHeader(folder / "a.nrrd", {});
  EXPECT_TRUE(header.areColors);
  EXPECT_EQ(header.space, ScanSpace::Patient);
  ASSERT_EQ(header.channels.size(), 3u);
  EXPECT_EQ(readColors(folder / "a.nrrd", {.array = "blue"}).scalar(3, 0, 0), float(numberAt(3, 2)));
  const Volume channel = readColors(folder / "a.nrrd", {.channels = {{.name = "green", .window = std::array{0.0f, 510.0f}}}});
  EXPECT_EQ(channel.scalar(3, 0, 0), float(numberAt(3, 1)) / 510.0f);
  EXPECT_EQ(channel.albedo->values[1].at({3, 0, 0}), 1.0f);
  const Volume luminance = readColors(folder / "a.nrrd", {.asColors = false});
  EXPECT_FALSE(luminance.albedo);
  EXPECT_EQ(luminance.scalar(3, 0, 0), readColors(folder / "a.nrrd").scalar(3, 0, 0));
  const Labels labels;
  EXPECT_EQ(errorOf([&] { readColors(folder / "a.nrrd", {.labels = &labels}); }).kind(), ErrorKind::Usage);
}

TEST(ColorScan, OpacityThatIsTheSameEverywhereSaysNothing) {
  const TemporaryFolder folder;
  std::string bytes = colorBytes(0, 165, 4);
  for (std::size_t i = 3; i < bytes.size(); i += 4) bytes[i] = '\xff';
  writeBytes(folder / "a.nrrd", nrrdOfColors(4) + bytes);
  expectColors(folder / "a.nrrd");
  writeBytes(folder / "b.nrrd", nrrdOfColors(3) + std::string(3 * 165, '\0'));
  expectRefusal([&] { readColors(folder / "b.nrrd"); }, ErrorKind::Input, {"b.nrrd", "black"});
}

TEST(ColorScan, VectorsThatAreNoColoursAreRefused) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& header, int components, int bytes) {
    writeBytes(folder / "a.nrrd", header + std::string(std::size_t(165 * components * bytes), 'x'));
    expectRefusal([&] { readColors(folder / "a.nrrd"); }, ErrorKind::Input, {"a.nrrd", std::to_string(components) + " numbers a voxel", "colours"});
  };
  expect(nrrdOfColors(3, "float"), 3, 4);
  expect(nrrdOfColors(3, "int16"), 3, 2);
  expect(nrrdOfColors(2), 2, 1);
  writeBytes(folder / "b.nrrd", nrrdOfColors(3) + std::string(100, 'x'));
  EXPECT_NE(std::string(errorOf([&] { readColors(folder / "b.nrrd"); }).what()).find("b.nrrd"), std::string::npos) << "cut";
}

}  // namespace
}  // namespace freevoxels::test
