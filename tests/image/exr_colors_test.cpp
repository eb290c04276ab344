// OpenEXR files as other programs write them: layers, parts, grey images, and colours of other spaces.

#include <ImfChromaticities.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/image/image.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// A part of a file: its channels, each of one value in all pixels.
struct Part {
  std::string name;
  std::vector<std::pair<std::string, float>> channels;
};

constexpr glm::ivec2 kSize(6, 3);

void write(const fs::path& file, const std::vector<Part>& parts, const std::optional<Imf::Chromaticities>& colors = std::nullopt) {
  std::vector<Imf::Header> headers;
  for (const Part& part : parts) {
    Imf::Header& header = headers.emplace_back(kSize.x, kSize.y);
    header.setType(Imf::SCANLINEIMAGE);
    header.setName(part.name);
    if (colors) Imf::addChromaticities(header, *colors);
    for (const auto& [name, value] : part.channels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  }
  Imf::MultiPartOutputFile exr(file.c_str(), headers.data(), int(headers.size()));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Imf::OutputPart part(exr, int(i));
    Imf::FrameBuffer frame;
    std::vector<std::vector<float>> pixels;
    for (const auto& [name, value] : parts[i].channels) {
      pixels.emplace_back(std::size_t(kSize.x * kSize.y), value);
      frame.insert(
          name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.back().data()), sizeof(float), sizeof(float) * std::size_t(kSize.x)));
    }
    part.setFrameBuffer(frame);
    part.writePixels(kSize.y);
  }
}

std::vector<std::pair<std::string, float>> layer(const std::string& prefix, float value) {
  return {{prefix + "A", 0.5f}, {prefix + "B", value + 2.0f}, {prefix + "G", value + 1.0f}, {prefix + "R", value}};
}

std::vector<std::pair<std::string, float>> joined(std::vector<std::pair<std::string, float>> a,
                                                  const std::vector<std::pair<std::string, float>>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class ExrColorsTest : public testing::Test {
 protected:
  glm::vec4 colorOf(const std::vector<Part>& parts, const std::optional<Imf::Chromaticities>& colors = std::nullopt) const {
    write(folder / "a.exr", parts, colors);
    const Image image = readExr(folder / "a.exr");
    EXPECT_EQ(image.size, kSize);
    for (const glm::vec4& pixel : image.pixels) EXPECT_EQ(pixel, image.pixels.front());
    return image.pixels.front();
  }
  const TemporaryFolder folder;
};

TEST_F(ExrColorsTest, TheImageOfARendererIsFoundAmongItsLayers) {
  const glm::vec4 wanted(3.0f, 4.0f, 5.0f, 0.5f);
  for (const char* name : {"ViewLayer.Combined.", "rgba.", "beauty.", "C.", "RGB.", "View Layer.Combined.", "anything."})
    EXPECT_EQ(colorOf({{"main", layer(name, 3.0f)}}), wanted) << name;
  for (const char* name : {"ViewLayer.Combined.", "rgba.", "Beauty."})
    EXPECT_EQ(colorOf({{"main", joined(layer("ViewLayer.Diffuse.", 9.0f), layer(name, 3.0f))}}), wanted) << name;
  EXPECT_EQ(colorOf({{"main", joined(layer("rgba.", 9.0f), layer("", 3.0f))}}), wanted) << "channels without a layer";
}

TEST_F(ExrColorsTest, TheImageMayBeInAnyPart) {
  const glm::vec4 wanted(3.0f, 4.0f, 5.0f, 0.5f);
  EXPECT_EQ(colorOf({{"depth", {{"Z", 7.0f}}}, {"color", layer("", 3.0f)}}), wanted);
  EXPECT_EQ(colorOf({{"normals", layer("N.", 9.0f)}, {"depth", {{"Z", 7.0f}}}, {"color", layer("rgba.", 3.0f)}}), wanted);
  write(folder / "a.exr", {{"normals", {{"N.X", 1.0f}}}, {"color", joined(layer("rgba.", 3.0f), {{"rgba.Z", 7.0f}})}});
  EXPECT_EQ(readExr(folder / "a.exr").depth.back(), 7.0f);
}

TEST_F(ExrColorsTest, LuminanceAloneIsGrey) {
  EXPECT_EQ(colorOf({{"main", {{"Y", 3.0f}}}}), glm::vec4(3.0f, 3.0f, 3.0f, 1.0f));
  EXPECT_EQ(colorOf({{"main", {{"A", 0.25f}, {"Y", 3.0f}}}}), glm::vec4(3.0f, 3.0f, 3.0f, 0.25f));
  EXPECT_EQ(colorOf({{"main", joined({{"Y", 9.0f}}, layer("", 3.0f))}}), glm::vec4(3.0f, 4.0f, 5.0f, 0.5f));
}

TEST_F(ExrColorsTest, LayersAmongWhichNoneIsTheImageAreListed) {
  write(folder / "a.exr", {{"main", joined(layer("diffuse.", 1.0f), layer("glossy.", 2.0f))}});
  test::expectRefusal([&] { readExr(folder / "a.exr"); }, ErrorKind::Input, {"a.exr", "2 layers", "diffuse", "glossy"});
  write(folder / "b.exr", {{"main", {{"Z", 7.0f}, {"u", 1.0f}}}});
  test::expectRefusal([&] { readExr(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", "no channels R, G and B"});
}

const Imf::Chromaticities kAcescg({0.713f, 0.293f}, {0.165f, 0.830f}, {0.128f, 0.044f}, {0.32168f, 0.33767f});
const Imf::Chromaticities kXyz({1.0f, 0.0f}, {0.0f, 1.0f}, {0.0f, 0.0f}, {1.0f / 3.0f, 1.0f / 3.0f});

TEST_F(ExrColorsTest, ColorsOfOtherSpacesBecomeThoseOfRec709) {
  const auto expectNear = [](const glm::vec4& color, const glm::vec3& wanted, const char* what) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], wanted[c], 2e-3) << what << ' ' << c;
  };
  const auto part = [](float r, float g, float b) { return std::vector<Part>{{"main", {{"B", b}, {"G", g}, {"R", r}}}}; };
  expectNear(colorOf(part(1, 1, 1), kAcescg), {1, 1, 1}, "white stays white");
  // ACES, "TB-2014-004" and colour-science: AP1 to Rec.709 with Bradford's adaptation.
  expectNear(colorOf(part(1, 0, 0), kAcescg), {1.70505f, -0.13026f, -0.02400f}, "ACEScg red");
  expectNear(colorOf(part(0, 0, 1), kAcescg), {-0.08326f, -0.01055f, 1.15297f}, "ACEScg blue");
  // IEC 61966-2-1: XYZ of D65 to linear sRGB.
  expectNear(colorOf(part(0.9505f, 1.0f, 1.0891f), kXyz), {1, 1, 1}, "XYZ of Rec.709's white");
  expectNear(colorOf(part(0.4124f, 0.2126f, 0.0193f), kXyz), {1, 0, 0}, "XYZ of Rec.709's red");
  EXPECT_EQ(colorOf(part(0.3f, 2.0f, 0.1f), Imf::Chromaticities()), glm::vec4(0.3f, 2.0f, 0.1f, 1.0f)) << "Rec.709 keeps its bits";
}

TEST_F(ExrColorsTest, ChromaticitiesThatSpanNothingAreIgnored) {
  const Imf::Chromaticities none({0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.0f});
  EXPECT_EQ(colorOf({{"main", layer("", 3.0f)}}, none), glm::vec4(3.0f, 4.0f, 5.0f, 0.5f));
}

}  // namespace
}  // namespace freevoxels
