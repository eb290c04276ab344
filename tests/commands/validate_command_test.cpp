// freevoxels-validate, run as a user runs it.

#include <algorithm>
#include <sstream>

#include "engine/volume/procedural.h"
#include "engine/volume/vdb.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

class ValidateCommand : public CommandTest {
 protected:
  ProgramResult validate(const std::string& text) const {
    return runProgramFile(FREEVOXELS_VALIDATE_PROGRAM, words(text));
  }
};

std::size_t linesWith(const std::string& text, const std::string& start) {
  std::istringstream stream(text);
  std::size_t count = 0;
  for (std::string line; std::getline(stream, line);) count += line.starts_with(start);
  return count;
}

}  // namespace

TEST_F(ValidateCommand, PassesOnSmallVolumesAndSaysSoLineByLine) {
  writeVdb(folder / "cloud.vdb", makeProcedural("cloud", 12), "density");
  const ProgramResult result = validate("@cloud.vdb --quick --resolution 8");
  expectSuccess(result);
  EXPECT_EQ(result.err, "");
  const std::size_t passed = linesWith(result.out, "  passed  ");
  EXPECT_EQ(linesWith(result.out, "  FAILED"), 0u) << result.out;
  EXPECT_EQ(linesWith(result.out, "PASSED: " + std::to_string(passed) + " checks, 0 failed"), 1u)
      << result.out;
  EXPECT_EQ(linesWith(result.out, "Closed forms"), 1u);
  // Seven procedural volumes and the file.
  EXPECT_EQ(linesWith(result.out, "Stages: "), 8u);
  EXPECT_EQ(linesWith(result.out, "Invariances: "), 8u);
  EXPECT_EQ(linesWith(result.out, "Emission: "), 1u);
  // Four procedural volumes, their summary, and the file.
  EXPECT_EQ(linesWith(result.out, "Image quality: "), 6u);
  // Figures 2, 6 and 7, and Eq. 9.
  EXPECT_EQ(linesWith(result.out, "Subr et al. 2007, "), 4u);
  EXPECT_NE(result.out.find("cloud.vdb density, "), std::string::npos) << result.out;
}

TEST_F(ValidateCommand, RefusesABadFileBeforeAnyWork) {
  writeBytes(folder / "bad.vdb", "no volume");
  for (const char* name : {"bad.vdb", "missing.vdb"}) {
    const ProgramResult result = validate(std::string("@") + name + " --quick");
    EXPECT_EQ(result.exitCode, int(ExitCode::Input));
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_TRUE(result.err.starts_with("freevoxels-validate: ")) << result.err;
    EXPECT_NE(result.err.find(name), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
  }
}

}  // namespace freevoxels::test
