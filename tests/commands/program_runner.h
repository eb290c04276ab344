#pragma once
// Runs the real program the way a user does, and says what came out.

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/common/failure.h"
#include "tests/temporary_folder.h"

namespace freevoxels::test {

struct ProgramResult {
  int exitCode = 0;  ///< minus the signal's number where a signal ended it
  std::string out, err;
  std::uint64_t peakBytes = 0;  ///< of memory that was resident
};

using Arguments = std::vector<std::string>;

/// Another program than freevoxels, by its path.
ProgramResult runProgramFile(const char* program, const Arguments& arguments);
ProgramResult runFreevoxels(const Arguments& arguments);

/// Whether this machine makes pseudo-terminals: some containers do not.
bool terminalsAvailable();

/// stderr is a terminal, whose contents become `err`.
ProgramResult runFreevoxelsOnTerminal(const Arguments& arguments);

/// Sends the signal after `milliseconds`.
ProgramResult runAndInterrupt(const Arguments& arguments, int signal, int milliseconds);

/// `words` split at blanks, each starting with '@' being a file of `folder`: "render @a.vdb @a.png --quiet".
Arguments words(const TemporaryFolder& folder, const std::string& words);

/// Value of a string attribute in an EXR's header, empty where there is none.
std::string exrAttribute(const std::string& bytes, const std::string& name);

/// The arguments of the command that an EXR says it was made by, with `output` in place of image.exr.
Arguments recordedCommand(const std::string& bytes, const std::filesystem::path& output);

/// Done, and no words wasted on it: fails with what the program said.
void expectSuccess(const ProgramResult& result);

/// This exit code, and on stderr one line that contains `mention`; nothing on stdout.
void expectRefusal(const ProgramResult& result, ExitCode code, const std::string& mention);

/// For tests of the program with files of their own.
class CommandTest : public testing::Test {
 protected:
  Arguments words(const std::string& text) const { return test::words(folder, text); }
  ProgramResult run(const std::string& text) const { return runFreevoxels(words(text)); }
  /// expectRefusal, and no file more or less than before.
  void expectCleanRefusal(const std::string& text, ExitCode code, const std::string& mention) const;

  TemporaryFolder folder;
};

}  // namespace freevoxels::test
