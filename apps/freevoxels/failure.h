#pragma once
// What an exception means to the user: an exit code and one sentence.

#include <string>

#include "engine/core/error.h"

namespace freevoxels {

struct Failure {
  ExitCode code = ExitCode::Internal;  ///< a program that fails so ends with it
  std::string sentence;
};

/// Describes the exception that is being handled: to be called in a catch block.
Failure currentFailure();

}  // namespace freevoxels
