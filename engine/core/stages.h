#pragma once
// What long work tells its caller: how far it is, and afterwards how long each stage took.

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace freevoxels {

/// Called with the stage's name and how much of it is done, 0..1. May be empty.
using Progress = std::function<void(std::string_view stage, double fraction)>;

struct StageTime {
  std::string name;
  double milliseconds = 0.0;
  bool onDevice = false;  ///< measured by the device's own clock
};

/// Appends the wall time of its scope to a list.
class StageTimer {
 public:
  StageTimer(std::vector<StageTime>& times, std::string name) : times_(times), name_(std::move(name)) {}
  ~StageTimer() { times_.push_back({name_, elapsedMilliseconds(), false}); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double elapsedMilliseconds() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }

  std::vector<StageTime>& times_;
  std::string name_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace freevoxels
