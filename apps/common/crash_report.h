#pragma once
// The last words of a program.

#include <string>

namespace freevoxels {

/// From here on what would end the process without a word ends it with one sentence on stderr that begins with `program`:
/// - a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) inside a CrashNote: its sentence, ExitCode::Input;
/// - any other crash: ExitCode::OutOfMemory where the address space is limited (ulimit -v), as the libraries below do not
///   check every allocation; else ExitCode::Internal;
/// - std::terminate: what currentFailure says of the exception.
/// A write beyond the limit on the size of files (ulimit -f) fails with EFBIG instead of ending the process.
/// For main(); sanitizers keep their own reports of crashes.
void reportCrashes(const std::string& program);

}  // namespace freevoxels
