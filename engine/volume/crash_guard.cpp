#include "engine/volume/crash_guard.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

// A signal handler must not allocate memory, so its text is prepared beforehand.
const char* guardedText = nullptr;
std::size_t guardedSize = 0;

extern "C" void exitWithSentence(int) {
  if (write(STDERR_FILENO, guardedText, guardedSize) < 0) _exit(int(ExitCode::Input));
  _exit(int(ExitCode::Input));
}

/// The beginning of every message: "freevoxels: ".
std::string messagePrefix() {
  const std::string& program = spdlog::default_logger()->name();
  return program.empty() ? "" : program + ": ";
}

}  // namespace

CrashGuard::CrashGuard(const std::string& sentence) : line_(messagePrefix() + sentence + "\n") {
  FV_CHECK_EQ(guardedSize, 0u);
  guardedText = line_.data();
  guardedSize = line_.size();
  struct sigaction handler {};
  handler.sa_handler = exitWithSentence;
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &handler, &before_[i]);
}

CrashGuard::~CrashGuard() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  guardedSize = 0;
}

}  // namespace freevoxels
