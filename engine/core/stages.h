#pragma once
// Progress and stage times of long work.

#include <algorithm>
#include <chrono>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace freevoxels {

/// Callback for the progress of a stage: its name and the fraction of it that is done, 0..1. May be empty. Long work of every kind, reading
/// as well as drawing, calls it from the thread that began the work; an exception that it throws abandons the work and is passed on.
using Progress = std::function<void(std::string_view stage, double fraction)>;

struct StageTime {
  std::string name;
  double milliseconds = 0.0;
  bool onDevice = false;  ///< measured by the device's own clock
};

/// Adds `time` to the entry of the same name, or appends it.
inline void addTime(std::vector<StageTime>& times, const StageTime& time) {
  const auto same = std::ranges::find(times, time.name, &StageTime::name);
  if (same == times.end())
    times.push_back(time);
  else
    same->milliseconds += time.milliseconds;
}

inline void addTimes(std::vector<StageTime>& sums, std::span<const StageTime> times) {
  for (const StageTime& time : times) addTime(sums, time);
}

/// Adds the wall time of its scope to a list.
class StageTimer {
 public:
  StageTimer(std::vector<StageTime>& times, std::string name) : times_(times), name_(std::move(name)) {}
  ~StageTimer() { addTime(times_, {name_, elapsedMilliseconds(), false}); }
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
