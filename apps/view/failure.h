#pragma once
// What went wrong beside the window, to be said in it.

#include <string>

#include "engine/core/error.h"

namespace freevoxels {

struct Failure {
  ExitCode code = ExitCode::Internal;  ///< what a program that does the same would end with
  std::string sentence;
};

/// Of the exception that is being handled.
Failure currentFailure();

}  // namespace freevoxels
