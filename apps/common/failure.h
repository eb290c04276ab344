#pragma once
// What errors mean to the users of the programs: exit codes, and sentences that name options.

#include <string>
#include <string_view>

#include "engine/core/error.h"

namespace freevoxels {

/// Exit codes of all programs, documented in apps/manual/exit_codes.md.
enum class ExitCode : int {
  Success = 0,
  Internal = 1,
  Usage = 2,
  Input = 3,
  Output = 4,
  Device = 5,
  OutOfMemory = 6,
  Comparison = 7  ///< `compare --fail-above` or a check of freevoxels-validate failed
};

/// The exit code of a program that fails with an error of this kind.
ExitCode exitCodeOf(ErrorKind kind);

/// A text of the engine or the options with its parameters as options of the command line: "--memory-limit", "--draw splats".
std::string withOptions(std::string_view text);
inline std::string withOptions(const Error& error) {
  return withOptions(error.text());
}

struct Failure {
  ExitCode code = ExitCode::Internal;  ///< a program that fails so ends with it
  std::string sentence;
};

/// Describes the exception that is being handled: to be called in a catch block.
Failure currentFailure();

}  // namespace freevoxels
