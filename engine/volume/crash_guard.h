#pragma once

#include <array>
#include <csignal>
#include <string>

namespace freevoxels {

/// While one lives, a crash of this process (SIGSEGV, SIGBUS, SIGABRT, SIGFPE) becomes one sentence on stderr
/// and ExitCode::Input: for a library that crashes on damaged files. At most one at a time.
class CrashGuard {
 public:
  explicit CrashGuard(const std::string& sentence);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  static constexpr std::array kSignals{SIGSEGV, SIGBUS, SIGABRT, SIGFPE};
  std::string line_;
  std::array<struct sigaction, kSignals.size()> before_;
};

}  // namespace freevoxels
