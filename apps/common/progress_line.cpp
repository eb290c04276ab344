#include "apps/common/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "engine/core/printable.h"

namespace freevoxels {

namespace {

constexpr const char* kEraseLine = "\r\033[K";
constexpr std::chrono::milliseconds kRefresh{50};

/// Whether standard error shows escape codes.
bool canEraseLines() {
  const char* const terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && (terminal == nullptr || std::string_view(terminal) != "dumb");
}

}  // namespace

ProgressLine::ProgressLine(bool wanted) : visible_(wanted && canEraseLines()) {}

ProgressLine::~ProgressLine() {
  erase();
}

void ProgressLine::begin(std::string_view stage) {
  if (visible_) print(fmt::format("{} ...", stage));
}

void ProgressLine::erase() {
  if (visible_) print("");
}

Progress ProgressLine::progress() {
  if (!visible_) return {};
  return [this](std::string_view stage, double fraction) { show(stage, fraction); };
}

void ProgressLine::show(std::string_view stage, double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (stage == stage_ && now - shown_ < kRefresh) return;
  stage_ = stage;
  shown_ = now;
  print(fmt::format("{} {:.0f} %", stage, 100.0 * fraction));
}

void ProgressLine::print(const std::string& text) {
  fmt::print(stderr, "{}{}", kEraseLine, printable(text));  // it has names of files
  std::fflush(stderr);
}

}  // namespace freevoxels
