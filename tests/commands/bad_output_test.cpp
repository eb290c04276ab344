// Outputs that cannot be written: exit code 4, and nothing half-written is left.

#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include "tests/commands/program_runner.h"
#include "tests/limited_disk.h"

namespace freevoxels::test {

namespace {

using BadOutput = CommandTest;
using BadOutputDeathTest = CommandTest;

constexpr const char* kRender = "render procedural:cube --resolution 16 --size 256x256 --quiet ";

/// On a disk of 4 KiB; the arguments' files lie on it.
void expectDiskFull(const TemporaryFolder& folder, const std::string& arguments) {
  SCOPED_TRACE(arguments);
  const auto runHere = [&](const std::filesystem::path&) {
    const ProgramResult result = runFreevoxels(words(folder, arguments));
    throw Error(ErrorKind(result.exitCode), result.err);
  };
  EXPECT_EXIT(exitWithErrorOnLimitedDisk(folder.path(), 4096, runHere),
              testing::ExitedWithCode(int(ExitCode::Output)), "^freevoxels: .*free some space");
}

}  // namespace

TEST_F(BadOutput, FolderThatIsNotThere) {
  expectCleanRefusal(std::string(kRender) + "@none/a.exr", ExitCode::Output, "none");
  expectCleanRefusal(std::string(kRender) + "@a.png @none/a.png", ExitCode::Output, "none");
  expectCleanRefusal(std::string(kRender) + "@a.png --timings @none/t.json", ExitCode::Output, "none");
  expectCleanRefusal("generate cube @none/a.vdb --resolution 16", ExitCode::Output, "none");
}

TEST_F(BadOutput, FolderInsteadOfFile) {
  std::filesystem::create_directory(folder / "a.exr");
  expectCleanRefusal(std::string(kRender) + "@a.exr", ExitCode::Output, "a.exr");
}

TEST_F(BadOutput, UnwritableFolder) {
  expectRefusal(run(std::string(kRender) + "/proc/a.exr"), ExitCode::Output, "/proc/a.exr");
  expectRefusal(run("generate cube /proc/a.vdb --resolution 16"), ExitCode::Output, "/proc/a.vdb");
}

TEST_F(BadOutput, SameFileTwice) {
  expectSuccess(run("generate cube @in.vdb --resolution 8 --quiet"));
  const std::string volume = readBytes(folder / "in.vdb");
  expectRefusal(run("render @in.vdb @a.png --timings @in.vdb"), ExitCode::Usage, "in.vdb");
  expectRefusal(run("render @in.vdb @a.png --timings @./a.png"), ExitCode::Usage, "a.png");
  expectRefusal(run("render @in.vdb @a.png @a.png"), ExitCode::Usage, "a.png");
  std::filesystem::create_symlink(folder / "in.vdb", folder / "link.png");
  expectRefusal(run("render @in.vdb @link.png"), ExitCode::Usage, "link.png");
  EXPECT_EQ(readBytes(folder / "in.vdb"), volume);
}

TEST_F(BadOutput, StandardOutputThatIsFull) {
  for (const char* arguments : {"info procedural:cube", "generate --list", "--help"}) {
    const std::string command =
        std::string(FREEVOXELS_PROGRAM) + " " + arguments + " > /dev/full 2> /dev/null";
    const int status = std::system(command.c_str());
    EXPECT_EQ(WEXITSTATUS(status), int(ExitCode::Output)) << arguments;
  }
}

TEST_F(BadOutput, WhatWasThereSurvivesAFailure) {
  writeBytes(folder / "a.exr", "precious");
  expectCleanRefusal("render @none.vdb @a.exr --quiet", ExitCode::Input, "none.vdb");
  EXPECT_EQ(readBytes(folder / "a.exr"), "precious");
}

TEST_F(BadOutputDeathTest, FullDisk) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  FV_REQUIRE_LIMITED_DISK(folder.path());
  const std::string image = "render procedural:cloud --resolution 24 --size 256x256 --quiet ";
  expectDiskFull(folder, image + "@a.exr");
  expectDiskFull(folder, image + "@a.png");
  expectDiskFull(folder, "generate cloud @a.vdb --resolution 48 --quiet");
}

TEST_F(BadOutput, AnInterruptLeavesNoTemporaryFile) {
  for (const int milliseconds : {50, 200, 400, 800}) {
    SCOPED_TRACE(milliseconds);
    runAndInterrupt(words("render procedural:cloud @a.exr --float --size 1024x1024 --resolution 64 --quiet"),
                    SIGINT, milliseconds);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      EXPECT_EQ(entry.path().filename(), "a.exr");
  }
}

/// A killed program cannot tidy up: there must be nothing to tidy.
TEST_F(BadOutput, AKilledProgramLeavesNoTemporaryFile) {
  for (const int milliseconds : {50, 200, 400, 800}) {
    SCOPED_TRACE(milliseconds);
    runAndInterrupt(words("render procedural:cloud @a.exr --float --size 1024x1024 --resolution 64 --quiet"), SIGKILL, milliseconds);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      EXPECT_EQ(entry.path().filename(), "a.exr");
  }
}

/// What a shell's ulimit does.
ProgramResult runLimited(const char* limit, const Arguments& arguments) {
  Arguments words{"-c", fmt::format("ulimit {}; exec \"$@\"", limit), "sh", FREEVOXELS_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return runProgramFile("/bin/bash", words);
}

TEST_F(BadOutput, LimitsOfTheShellEndInOneSentence) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer needs the address space";
#endif
  const Arguments render = words(std::string(kRender) + "@a.exr");
  expectRefusal(runLimited("-f 4", render), ExitCode::Output, "ulimit -f");
  expectRefusal(runLimited("-f 4", words("generate cloud @cloud.vdb --resolution 32 --quiet")), ExitCode::Output, "ulimit -f");
  // Around 390000 Mesa frees memory twice where it cannot make its device, of which the C library has a line of its own.
  for (const char* space : {"-v 200000", "-v 500000"}) expectRefusal(runLimited(space, render), ExitCode::OutOfMemory, "ulimit -v");
  EXPECT_EQ(folder.fileCount(), 0u);
}

}  // namespace freevoxels::test
