#pragma once
// What is told of the last complete frame, to any thread.

#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "engine/core/stages.h"

namespace freevoxels {

class LastFrame {
 public:
  /// `camera` has the keywords of the frame's camera.
  void set(std::vector<StageTime> timings, nlohmann::json camera) {
    const std::lock_guard lock(mutex_);
    timings_ = std::move(timings);
    camera_ = std::move(camera);
  }
  std::vector<StageTime> timings() const {
    const std::lock_guard lock(mutex_);
    return timings_;
  }
  nlohmann::json camera() const {
    const std::lock_guard lock(mutex_);
    return camera_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<StageTime> timings_;
  nlohmann::json camera_ = nlohmann::json::object();
};

}  // namespace freevoxels
