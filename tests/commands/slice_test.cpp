// Slices and bars on the command line.
#include <cmath>

#include "engine/image/image.h"
#include "tests/commands/render_fixture.h"

namespace freevoxels {
namespace {

using test::expectSuccess;
using test::readBytes;

using SliceCommand = test::RenderCommand;

constexpr const char* kHead = "render procedural:head --resolution 24 --size 40x32 ";

TEST_F(SliceCommand, DrawsAPlaneInTheColoursOfTheFunction) {
  expectSuccess(run(std::string(kHead) + "@a.exr --slice z:50% --transfer-function viridis"));
  const Image image = readExr(folder / "a.exr");
  ASSERT_EQ(image.size, glm::ivec2(40, 32));
  EXPECT_EQ(image.pixels[16 * 40 + 20].a, 1.0f);
  EXPECT_EQ(image.pixels[16 * 40].a, 0.0f) << "beside the cube";
  expectSuccess(run(std::string(kHead) + "@b.exr --slice z:50% --transfer-function viridis --window 0..10"));
  EXPECT_NE(readExr(folder / "b.exr").pixels, image.pixels);
}

TEST_F(SliceCommand, TheSceneOfASliceDrawsItAgain) {
  expectSuccess(run(std::string(kHead) + "@a.png --slice y:40% --annotate --save-scene @s.json"));
  expectSuccess(run("render --scene @s.json @b.png"));
  EXPECT_EQ(readBytes(folder / "a.png"), readBytes(folder / "b.png"));
}

TEST_F(SliceCommand, BarsAreInEveryFileAndWarnedOfWhereThereAreNone) {
  expectSuccess(run(std::string(kHead) + "@a.png @a.exr @a.jpg --transfer-function viridis --annotate"));
  expectSuccess(run(std::string(kHead) + "@b.png @b.exr @b.jpg --transfer-function viridis"));
  for (const char* const ending : {".png", ".exr", ".jpg"})
    EXPECT_NE(readBytes(folder / ("a" + std::string(ending))), readBytes(folder / ("b" + std::string(ending)))) << ending;
  const test::ProgramResult none = run("render procedural:cloud --resolution 16 --size 40 @c.png --annotate");
  EXPECT_EQ(none.exitCode, 0);
  EXPECT_NE(none.err.find("--annotate has nothing to draw"), std::string::npos) << none.err;
}

TEST_F(SliceCommand, WhatHasNoPartInASliceIsRefused) {
  const std::string slice = std::string(kHead) + "@a.png --slice z:50% ";
  for (const char* const option : {"--mode mip", "--iso 0.5", "--orbit 1,2", "--add procedural:cloud"})
    expectCleanRefusal(slice + option, ExitCode::Usage, "--slice");
  expectCleanRefusal(slice + "--draw splats", ExitCode::Usage, "--slice");
  expectCleanRefusal(slice + "--share 0/2", ExitCode::Usage, "--slice");
  expectCleanRefusal(std::string(kHead) + "@a.png --slice z:50", ExitCode::Usage, "z:50%");
  expectCleanRefusal(std::string(kHead) + "@a.png --slice 50", ExitCode::Usage, "AXIS:POSITION");
  expectCleanRefusal("turntable procedural:head @a_#.png --slice z:50%", ExitCode::Usage, "--slice");
}

}  // namespace
}  // namespace freevoxels
