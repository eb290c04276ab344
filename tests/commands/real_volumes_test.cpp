// Real files, where there are some: each one is drawn, or refused in one sentence.

#include <algorithm>
#include <set>

#include "engine/image/image.h"
#include "engine/image/metrics.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

const std::filesystem::path kData = FREEVOXELS_DATA_DIR;

class RealVolumes : public CommandTest {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(kData)) GTEST_SKIP() << "there are no real volumes in " << kData;
  }
  ProgramResult render(const std::filesystem::path& file) const {
    return runFreevoxels({"render", file.string(), (folder / "a.exr").string(), (folder / "a.png").string(),
                          "--size", "64x64", "--quiet"});
  }
};

}  // namespace

TEST_F(RealVolumes, TheWellKnownOnesShow) {
  for (const char* name : {"wdas_cloud_sixteenth.vdb", "smoke1.vdb", "dragon_with_xform.vdb",
                           "usd_smoke_000003.vdb", "sphere_ls.vdb"}) {
    SCOPED_TRACE(name);
    if (!std::filesystem::exists(kData / name)) continue;
    expectSuccess(render(kData / name));
    const Image image = readExr(folder / "a.exr");
    const auto visible = std::ranges::count_if(image.pixels, [](glm::vec4 pixel) { return pixel.a > 0.2f; });
    EXPECT_GT(visible, 64 * 64 / 20);
  }
}

/// As the oracle's do, on a screen.
TEST_F(RealVolumes, FiresShine) {
  for (const char* name : {"usd_densityAndHeat.vdb", "blender_fluid_0050.vdb"}) {
    SCOPED_TRACE(name);
    if (!std::filesystem::exists(kData / name)) continue;
    const auto draw = [&](const char* command) {
      Arguments arguments{command, (kData / name).string(), (folder / "a.png").string()};
      // No ambient light, which takes the oracle minutes; a pixel is about a voxel.
      for (const char* word : {"--size", "24x24", "--quiet", "--background", "0,0,0", "--emission", "--light", "direction=0.3,1,0.4"})
        arguments.emplace_back(word);
      expectSuccess(runFreevoxels(arguments));
      return readPng(folder / "a.png");
    };
    const Image truth = draw("oracle");
    EXPECT_GE(compareImages(draw("render"), truth).psnr, 38.0);
    const auto shining = std::ranges::count_if(truth.pixels, [](glm::vec4 pixel) { return pixel.r > 0.5f; });
    EXPECT_GE(shining, 3);  // one of the flames is behind its smoke
  }
}

TEST_F(RealVolumes, EveryFileIsDrawnOrRefused) {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kData))
    if (entry.is_regular_file()) files.insert(entry.path());
  ASSERT_FALSE(files.empty());
  int drawn = 0;
  for (const std::filesystem::path& file : files) {
    SCOPED_TRACE(file.string());
    const ProgramResult result = render(file);
    if (result.exitCode == 0) {
      ++drawn;
      EXPECT_EQ(folder.fileCount(), 2u);
      std::filesystem::remove(folder / "a.exr");
      std::filesystem::remove(folder / "a.png");
    } else {
      expectRefusal(result, ExitCode::Input, file.filename().string());
      EXPECT_EQ(folder.fileCount(), 0u);
    }
  }
  EXPECT_GT(drawn, 0);
}

TEST_F(RealVolumes, InfoReadsEveryOpenVdbFile) {
  for (const auto& entry : std::filesystem::directory_iterator(kData)) {
    if (entry.path().extension() != ".vdb") continue;
    SCOPED_TRACE(entry.path().string());
    const ProgramResult result = runFreevoxels({"info", entry.path().string()});
    expectSuccess(result);
    EXPECT_GE(std::ranges::count(result.out, '\n'), 2);
  }
}

}  // namespace freevoxels::test
