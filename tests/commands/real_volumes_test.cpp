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

/// As the oracle's do, on a screen: whole, and a part of each in a light, whose shadow rays take the oracle twenty times as long.
TEST_F(RealVolumes, FiresShine) {
  struct Fire {
    const char* name;
    const char* part;
  };
  for (const Fire& fire : {Fire{"usd_densityAndHeat.vdb", "6,6,0,15,15,9"}, Fire{"blender_fluid_0050.vdb", "8,4,6,17,13,15"}}) {
    SCOPED_TRACE(fire.name);
    if (!std::filesystem::exists(kData / fire.name)) continue;
    const auto draw = [&](const char* command, const Arguments& look) {
      Arguments arguments{command,     (kData / fire.name).string(), (folder / "a.png").string(), "--quiet", "--background", "0,0,0",
                          "--emission"};
      arguments.insert(arguments.end(), look.begin(), look.end());
      expectSuccess(runFreevoxels(arguments));
      return readPng(folder / "a.png");
    };
    // A pixel is about a voxel. No ambient light, which takes the oracle minutes.
    const Arguments whole{"--size", "24x24", "--unlit"}, lit{"--size", "16x16", "--light", "direction=0.3,1,0.4", "--clip-box", fire.part};
    for (const Arguments& look : {whole, lit}) {
      const Image truth = draw("oracle", look);
      EXPECT_GE(compareImages(draw("render", look), truth).psnr, 38.0) << look.back();
      const auto shining = std::ranges::count_if(truth.pixels, [](glm::vec4 pixel) { return pixel.r > 0.5f; });
      EXPECT_GE(shining, 3) << look.back();  // one of the flames is behind its smoke
    }
  }
}

TEST_F(RealVolumes, EveryFileIsDrawnOrRefusedAndTheWellKnownOnesShow) {
  const std::set<std::string> wellKnown{"wdas_cloud_sixteenth.vdb", "smoke1.vdb", "dragon_with_xform.vdb", "usd_smoke_000003.vdb",
                                        "sphere_ls.vdb"};
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kData))
    if (entry.is_regular_file()) files.insert(entry.path());
  ASSERT_FALSE(files.empty());
  int drawn = 0;
  for (const std::filesystem::path& file : files) {
    SCOPED_TRACE(file.string());
    const ProgramResult result = render(file);
    if (wellKnown.contains(file.filename().string())) {
      expectSuccess(result);
      const Image image = readExr(folder / "a.exr");
      const auto visible = std::ranges::count_if(image.pixels, [](glm::vec4 pixel) { return pixel.a > 0.2f; });
      EXPECT_GT(visible, 64 * 64 / 20);
    }
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
