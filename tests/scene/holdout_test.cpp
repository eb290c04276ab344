// Depths of other programs: which channel of an .exr has them, and what is no depth.

#include "engine/scene/holdout.h"

#include <ImfOutputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/error.h"
#include "engine/image/image.h"
#include "tests/image/exr_parts.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::TemporaryFolder;

constexpr float kNothing = std::numeric_limits<float>::infinity();

/// Writes 2x1 pixels of these channels; channel number c has 10 c + 1 and 10 c + 2.
void writeChannels(const std::filesystem::path& file, const std::vector<std::string>& names) {
  Imf::Header header(2, 1);
  Imf::FrameBuffer frame;
  std::vector<std::array<float, 2>> values(names.size());
  for (std::size_t c = 0; c < names.size(); ++c) {
    values[c] = {10.0f * float(c) + 1.0f, 10.0f * float(c) + 2.0f};
    header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
    frame.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values[c].data()), sizeof(float), 2 * sizeof(float)));
  }
  Imf::OutputFile exr(file.c_str(), header);
  exr.setFrameBuffer(frame);
  exr.writePixels(1);
}

TEST(Holdout, DepthIsZOrThatOfALayerOrTheOnlyChannel) {
  const TemporaryFolder folder;
  const auto file = folder / "a.exr";
  for (const auto& [names, first] :
       std::vector<std::pair<std::vector<std::string>, float>>{{{"R", "G", "B", "Z"}, 31.0f},
                                                               {{"Z"}, 1.0f},
                                                               {{"V"}, 1.0f},
                                                               {{"View Layer.Normal.Z", "View Layer.Depth.Z", "R"}, 11.0f},
                                                               {{"P.Z", "depth.Z"}, 11.0f}}) {
    writeChannels(file, names);
    const auto holdout = readHoldout(file);
    EXPECT_EQ(holdout->size, glm::ivec2(2, 1));
    EXPECT_EQ(holdout->depths, (std::vector<float>{first, first + 1.0f})) << names.front();
  }
  writeChannels(file, {"R", "G", "B"});
  test::expectRefusal([&] { readHoldout(file); }, ErrorKind::Input, {"it has 3 channels and no channel Z"});
  writeChannels(file, {"a.Depth.Z", "b.Depth.Z"});
  test::expectRefusal([&] { readHoldout(file); }, ErrorKind::Input, {"it has 2 layers of depths"});
}

TEST(Holdout, ThereIsNothingBesideThePartThatAFileHas) {
  const TemporaryFolder folder;
  const Image part{.size = {2, 1}, .pixels = std::vector<glm::vec4>(2), .depth = {3.0f, 1e10f}, .wholeSize = {4, 3}, .offset = {1, 2}};
  writeExr(folder / "a.exr", part, {});
  const auto holdout = readHoldout(folder / "a.exr");
  EXPECT_EQ(holdout->size, glm::ivec2(4, 3));
  EXPECT_EQ(holdout->depths, (std::vector<float>{kNothing, kNothing, kNothing, kNothing, kNothing, kNothing, kNothing, kNothing, kNothing,
                                                 3.0f, 1e10f, kNothing}));
  test::expectRefusal([&] { checkHoldoutSize(*holdout, {4, 4}); }, ErrorKind::Usage, {"has 4x3 pixels, and that to be drawn 4x4"});
}

TEST(Holdout, WhatIsNoDistanceIsRefused) {
  for (const float value : {-1.0f, std::nanf("")})
    test::expectRefusal([&] { checkHoldout({.size = {2, 1}, .depths = {0.0f, value}}, "'a.exr'"); }, ErrorKind::Input, {"at pixel (1, 0)"});
}

}  // namespace
}  // namespace freevoxels
