#pragma once

#include <array>
#include <csignal>
#include <string>

namespace freevoxels {

/// As long as it exists, a crash of this process (SIGSEGV, SIGBUS, SIGABRT, SIGFPE) prints one sentence on
/// stderr and exits with ExitCode::Input: for a library that crashes on damaged files. At most one may exist
/// at a time.
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
