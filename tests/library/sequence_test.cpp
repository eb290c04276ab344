// Films through the installed interface: the command line's images, and what a Sequence says of its files.

#include <fmt/format.h>
#include <freevoxels/freevoxels.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "tests/library/expect_error.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

/// A folder with frames, in which the program runs.
class SequenceTest : public ::testing::Test {
 protected:
  void run(const std::string& arguments) const {
    const std::string command = fmt::format("cd '{}' && '{}' {} --quiet", folder_.path().string(), FREEVOXELS_PROGRAM, arguments);
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
  }
  void SetUp() override {
    run("generate cloud f_1.vdb --resolution 12");
    run("generate cloud f_2.vdb --resolution 9x14x11");
    run("bake f_1.vdb b_1.fvx");
    run("generate cloud f_4.vdb --resolution 21x16x14");
    run("bake f_4.vdb b_2.fvx");
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  const test::TemporaryFolder folder_;
};

TEST_F(SequenceTest, ImagesAreThoseOfTheCommandLine) {
  struct Case {
    const char *pattern, *options, *scene;
  };
  for (const Case& one : {Case{"f_#.vdb", "", ""}, Case{"b_#.fvx", "--orbit 120,-10", R"(, "orbit": [120, -10])"},
                          Case{"f_%d.vdb", "--frames 1-2 --fixed-view", R"(, "frames": "1-2", "fixed_view": true)"},
                          Case{"b_#.fvx", "--no-fixed-view --draw splats", R"(, "fixed-view": false, "draw": "splats")"}}) {
    run(fmt::format("render '{}' theirs_#.png --size 32x24 {}", one.pattern, one.options));
    v1::Sequence sequence({path(one.pattern)}, fmt::format(R"({{"size": [32, 24]{}}})", one.scene));
    const std::vector<std::string> written = sequence.save({path("ours_#.png"), path("also_#.png")});
    ASSERT_EQ(written.size(), 2 * sequence.size());
    for (std::size_t i = sequence.size(); i-- > 0;) {
      const std::string theirs = test::readBytes(folder_ / fmt::format("theirs_{}.png", sequence.numbers()[i]));
      v1::save(path("one.png"), sequence.render(i));
      for (const std::string& ours : {path("one.png"), written[2 * i], written[2 * i + 1]})
        EXPECT_TRUE(test::readBytes(ours) == theirs) << one.pattern << one.options << " " << ours;
    }
  }
}

TEST_F(SequenceTest, SaysWhatItKnows) {
  v1::Sequence sequence({path("f_#.vdb")}, R"({"size": [32, 24]})");
  EXPECT_EQ(sequence.size(), 3u);
  EXPECT_EQ(sequence.numbers(), (std::vector{1.0, 2.0, 4.0}));
  EXPECT_EQ(sequence.files().back(), path("f_4.vdb"));
  EXPECT_EQ(sequence.camera(), "{}");
  ASSERT_EQ(sequence.warnings().size(), 1u);
  EXPECT_NE(sequence.warnings().front().find("has no file of frame 3"), std::string::npos);
  EXPECT_TRUE(sequence.remarks().empty());
  const v1::Image image = sequence.render(0, R"({"orbit": [10, 20]})", {.depth = true});
  EXPECT_EQ(image.depth.size(), 32u * 24u);
  EXPECT_FALSE(sequence.timings().empty());
  EXPECT_FALSE(sequence.device().empty());
  ASSERT_FALSE(sequence.remarks().empty());
  EXPECT_NE(sequence.remarks().front().find(R"(those of the whole film, in which f_4.vdb holds most; change it with "fixed-view")"),
            std::string::npos)
      << sequence.remarks().front();
  // What the frame before showed is shown again by its camera.
  EXPECT_EQ(sequence.render(0, sequence.camera(), {.depth = true}).pixels, image.pixels);
}

TEST_F(SequenceTest, EmptyAndDamagedFramesAreThoseOfTheCommandLine) {
  test::writeBytes(folder_ / "f_3.vdb", "no volume");
  v1::Sequence sequence({path("f_#.vdb")}, R"({"size": [32, 24]})");
  expectRefused(v1::ErrorKind::Input, "f_3.vdb", [&] { sequence.render(2); });
  EXPECT_EQ(sequence.render(3).width, 32);
  expectRefused(v1::ErrorKind::Input, "1 of 4 volumes could not be drawn", [&] { sequence.save({path("i_#.png")}); });
  EXPECT_FALSE(std::filesystem::exists(folder_ / "i_3.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "i_4.png"));
}

TEST_F(SequenceTest, ProgressGrowsAndAbandons) {
  v1::Context context;
  v1::Sequence sequence(context, {path("f_1.vdb"), path("f_4.vdb")}, R"({"size": [32, 24]})");
  double before = 0.0;
  const auto grows = [&](std::string_view, double fraction) {
    EXPECT_GE(fraction, before);
    before = fraction;
  };
  const v1::Image whole = sequence.render(1, "{}", {.progress = grows});
  EXPECT_EQ(before, 1.0);
  for (const int calls : {0, 1}) {
    v1::Sequence fresh(context, {path("f_1.vdb"), path("f_4.vdb")}, R"({"size": [32, 24]})");
    const auto abandon = [left = calls](std::string_view, double) mutable {
      if (left-- == 0) throw std::runtime_error("abandoned");
    };
    EXPECT_THROW(fresh.render(1, "{}", {.progress = abandon}), std::runtime_error);
    const v1::Sequence moved = std::move(fresh);
    EXPECT_EQ(moved.camera(), "{}");
    fresh = v1::Sequence(context, {path("f_1.vdb"), path("f_4.vdb")}, R"({"size": [32, 24]})");
    EXPECT_EQ(fresh.render(1).pixels, whole.pixels);
  }
}

TEST_F(SequenceTest, WhatMakesNoSenseIsNamed) {
  using enum v1::ErrorKind;
  const auto make = [this](const char* name, const char* scene) { return [=, this] { v1::Sequence({path(name)}, scene); }; };
  expectRefused(Input, "there is no frame of", make("x_#.vdb", "{}"));
  expectRefused(Usage, "there is no volume to draw", [] { v1::Sequence({}, "{}"); });
  expectRefused(Usage, R"("frames" takes A-B)", make("f_#.vdb", R"({"frames": "1,2"})"));
  expectRefused(Usage, R"("frames" takes A-B)", make("f_#.vdb", R"({"frames": [1, 2]})"));
  expectRefused(Usage, R"("fixed-view" takes true or false)", make("f_#.vdb", R"({"fixed-view": 1})"));
  expectRefused(Usage, R"(did you mean "density-scale")", make("f_#.vdb", R"({"densty-scale": 1})"));
  v1::Sequence sequence({path("f_#.vdb")});
  expectRefused(Usage, "there is no frame 3: the sequence has 3", [&] { sequence.render(3); });
  expectRefused(Usage, R"("memory-limit" has no effect here)",
                [this] { v1::Sequence(v1::Context(), {path("f_#.vdb")}, R"({"memory-limit": 9})"); });
  expectRefused(Usage, "put a run of #", [&] { sequence.save({path("a.png")}); });
}

}  // namespace
}  // namespace freevoxels
