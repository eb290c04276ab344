// How much memory an image takes, and --memory-limit.

#include <nlohmann/json.hpp>

#include "tests/commands/program_runner.h"
#include "tests/image_measures.h"

namespace freevoxels::test {

namespace {

constexpr std::uint64_t kMiB = std::uint64_t(1) << 20;

class MemoryLimit : public CommandTest {
 protected:
  /// Bytes on the device, at most, that a run said it had.
  std::uint64_t devicePeak() const {
    return nlohmann::json::parse(readBytes(folder / "t.json"))["memory_bytes"]["peak"];
  }
};

}  // namespace

TEST_F(MemoryLimit, IsKeptOrTheRunSaysWhatItNeeds) {
  const std::string command = "render procedural:cloud --unlit --draw gather --resolution 72 --size 200x150 --quiet --timings @t.json @";
  expectSuccess(run(command + "free.exr"));
  const std::uint64_t free = devicePeak();
  int refused = 0, drawn = 0;
  for (const std::uint64_t limit :
       {std::uint64_t(1), free / kMiB / 2, free / kMiB, free / kMiB + 1, free / kMiB + 9}) {
    SCOPED_TRACE(limit);
    const ProgramResult result = run(command + fmt::format("limited.exr --memory-limit {}", limit));
    if (result.exitCode == 0) {
      ++drawn;
      EXPECT_LE(devicePeak(), limit * kMiB);
      if (limit * kMiB >= free)
        EXPECT_EQ(readBytes(folder / "limited.exr"), readBytes(folder / "free.exr"));
      else
        EXPECT_GE(psnr(readExr(folder / "limited.exr"), readExr(folder / "free.exr")), 60.0);
    } else {
      ++refused;
      expectRefusal(result, ExitCode::OutOfMemory, "--memory-limit");
      EXPECT_NE(result.err.find("MiB of device memory"), std::string::npos) << result.err;
    }
  }
  EXPECT_GE(refused, 1);
  EXPECT_GE(drawn, 2);
}

/// The MiB that a refusal says are needed.
int neededMiB(const ProgramResult& result) {
  const std::size_t at = result.err.find(" MiB of device memory");
  EXPECT_NE(at, std::string::npos) << result.err;
  return at == std::string::npos ? 0 : std::stoi(result.err.substr(result.err.rfind(' ', at - 1)));
}

TEST_F(MemoryLimit, IsRaisedOnceOnlyWhateverItIs) {
  for (const char* scene : {"procedural:cloud --resolution 56 --size 160x120 ", "procedural:head --resolution 48 --size 320x200 "}) {
    SCOPED_TRACE(scene);
    const std::string command = std::string("render ") + scene + "--quiet @a.png --memory-limit ";
    const int needed = neededMiB(run(command + "1"));
    ASSERT_GT(needed, 1);
    // More is never too little, although more and more of it lets the gather draw.
    for (const double part : {1.0, 1.5, 2.2, 4.0}) expectSuccess(run(command + std::to_string(int(part * needed))));
    const ProgramResult less = run(command + std::to_string(needed / 3));
    if (less.exitCode != 0) { EXPECT_EQ(neededMiB(less), needed) << "what was said at first"; }
  }
}

TEST_F(MemoryLimit, BadValuesAreRefused) {
  for (const char* value : {"0", "-1", "1.5", "much", "99999999999"})
    expectCleanRefusal(std::string("render procedural:cube @a.png --memory-limit ") + value, ExitCode::Usage,
                       "--memory-limit");
}

/// A box of which a twentieth is smoke.
TEST_F(MemoryLimit, SparseSmokeIn512CubedTakesLessThanAGibibyteOfHostAndDevice) {
  const ProgramResult result =
      run("render procedural:plume --unlit --resolution 640 --size 160x160 --timings @t.json @a.exr");
  expectSuccess(result);
  const auto report = nlohmann::json::parse(readBytes(folder / "t.json"));
  const double voxels = report["voxels"], visible = report["visible_voxels"];
  EXPECT_GT(voxels, 512.0 * 512 * 512);
  EXPECT_NEAR(visible / voxels, 0.05, 0.005);
  if (report["device"]["type"] != "CPU") {
    EXPECT_LT(devicePeak() + result.peakBytes, 1024 * kMiB);
  } else {
    EXPECT_LT(result.peakBytes, 1024 * kMiB);  // the device's memory is the host's
  }
}

}  // namespace freevoxels::test
