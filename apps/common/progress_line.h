#pragma once
// A progress line on a terminal, erased at the end. Does nothing if stderr is not a terminal.

#include <chrono>

#include "engine/core/stages.h"

namespace freevoxels {

class ProgressLine {
 public:
  explicit ProgressLine(bool wanted);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows a stage of unknown length.
  void begin(std::string_view stage);
  /// Erases the line; to be called before printing a message.
  void erase();
  /// Returns a progress function that refers to this object, or an empty one if nothing is shown.
  Progress progress();

 private:
  void show(std::string_view stage, double fraction);
  void print(const std::string& text);

  bool visible_;
  std::string stage_;
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace freevoxels
