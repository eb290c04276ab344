// freevoxels oracle: the scene options of render, another way to the image.

#include <algorithm>
#include <cmath>

#include "engine/image/image.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

constexpr const char* kSmallOracle = " --resolution 24 --size 48x32 ";

class OracleCommand : public CommandTest {
 protected:
  std::string march(const std::string& options, const std::string& file = "a.exr") const {
    SCOPED_TRACE(options);
    expectSuccess(run("oracle procedural:cloud --unlit @" + file + kSmallOracle + options));
    return readBytes(folder / file);
  }
};

}  // namespace

TEST_F(OracleCommand, WritesEveryOutputAndPrintsItsPath) {
  const ProgramResult result =
      run(std::string("oracle procedural:cloud --unlit @a.exr @b.png --aov depth --background 0.2,0.1,0") + kSmallOracle);
  expectSuccess(result);
  EXPECT_EQ(result.out, (folder / "a.exr").string() + "\n" + (folder / "b.png").string() + "\n");
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(folder.fileCount(), 2u);
  const Image image = readExr(folder / "a.exr");
  ASSERT_EQ(image.size, glm::ivec2(48, 32));
  EXPECT_GT(image.pixels[48 * 16 + 24].a, 0.3f);
  EXPECT_EQ(image.pixels[0], glm::vec4(0.0f));
  ASSERT_EQ(image.depth.size(), image.pixels.size());
  EXPECT_TRUE(std::isfinite(image.depth[48 * 16 + 24]));
  EXPECT_TRUE(std::isinf(image.depth[0]));
}

TEST_F(OracleCommand, ShowsWhatRenderShows) {
  const std::string scene = " procedural:cube @a.exr --resolution 24 --size 48x32 --density-scale 3 --float --unlit";
  expectSuccess(run("oracle" + scene));
  const Image oracle = readExr(folder / "a.exr");
  expectSuccess(run("render" + scene + " --quiet"));
  const Image splats = readExr(folder / "a.exr");
  double squares = 0.0;
  for (std::size_t i = 0; i < oracle.pixels.size(); ++i)
    squares += std::pow(double(oracle.pixels[i].a) - splats.pixels[i].a, 2.0);
  EXPECT_GT(-10.0 * std::log10(squares / double(oracle.pixels.size())), 35.0);
}

TEST_F(OracleCommand, TheSameCommandGivesTheSameBytes) {
  const std::string first = march("--aov depth");
  EXPECT_EQ(first, march("--aov depth", "b.exr"));
  EXPECT_NE(first.find("freevoxels oracle procedural:cloud"), std::string::npos) << "the recorded command";
  EXPECT_EQ(first.find("freevoxels render"), std::string::npos);
}

TEST_F(OracleCommand, SceneOptionsChangeTheImage) {
  writeBytes(folder / "red.json", R"({"opacity":[[0,0],[1,0.5]],"color":[[0,1,0,0]]})");
  const std::string standard = march("");
  for (const std::string& options :
       {std::string("--orbit 10,10"), std::string("--orthographic 1"), std::string("--density-scale 3"),
        std::string("--albedo 1,0,0"), "--transfer-function " + (folder / "red.json").string()})
    EXPECT_NE(standard, march(options)) << options;
}

TEST_F(OracleCommand, QuietPrintsNothingAndVerboseSaysHowWell) {
  const ProgramResult quiet = run(std::string("oracle procedural:cloud @a.png --unlit --quiet") + kSmallOracle);
  expectSuccess(quiet);
  EXPECT_EQ(quiet.out + quiet.err, "");
  const ProgramResult verbose = run(std::string("oracle procedural:cloud @a.png --unlit --verbose") + kSmallOracle);
  expectSuccess(verbose);
  for (const char* word : {"--density-scale", "--camera-position", "48x32", "rays", "largest change"})
    EXPECT_NE(verbose.err.find(word), std::string::npos) << word << " should be in\n" << verbose.err;
}

TEST_F(OracleCommand, ProgressIsForTerminalsAndErased) {
  if (!terminalsAvailable()) GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  const Arguments arguments = words(std::string("oracle procedural:cloud @a.png --unlit") + kSmallOracle);
  const ProgramResult shown = runFreevoxelsOnTerminal(arguments);
  expectSuccess(shown);
  EXPECT_NE(shown.err.find("rays a pixel"), std::string::npos) << shown.err;
  EXPECT_TRUE(shown.err.ends_with("\r\033[K"));
}

TEST_F(OracleCommand, BadInputsAndOptionsAreRefused) {
  expectCleanRefusal("oracle @none.vdb @a.exr", ExitCode::Input, "none.vdb");
  expectCleanRefusal("oracle procedural:cloud @none/a.exr", ExitCode::Output, "a.exr");
  expectCleanRefusal("oracle procedural:cloud", ExitCode::Usage, "OUT");
  expectCleanRefusal("oracle procedural:cloud @a.exr @a.exr", ExitCode::Usage, "same file");
  expectCleanRefusal("oracle procedural:cloud @a.tif", ExitCode::Usage, "a.tif");
  expectCleanRefusal("oracle procedural:cloud @a.png --code linear8", ExitCode::Usage, "--code");
  expectCleanRefusal("oracle procedural:cloud @a.png --up 0,0,0", ExitCode::Usage, "--up");
  expectCleanRefusal("oracle procedural:cloud @a.png --transfer-function @none.json", ExitCode::Input,
                     "none.json");
}

}  // namespace freevoxels::test
