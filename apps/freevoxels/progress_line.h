#pragma once
// One line on a terminal that says how far the work is, erased at the end. Nothing where stderr is not a
// terminal.

#include <chrono>

#include "engine/core/stages.h"

namespace freevoxels {

class ProgressLine {
 public:
  explicit ProgressLine(bool wanted);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// A stage whose length is not known.
  void begin(std::string_view stage);
  /// Before a message is printed.
  void erase();
  /// Refers to this object; empty where nothing is shown.
  Progress progress();

 private:
  void show(std::string_view stage, double fraction);
  void print(const std::string& text);

  bool visible_;
  std::string stage_;
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace freevoxels
