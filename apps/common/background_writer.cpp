#include "apps/common/background_writer.h"

#include <utility>

namespace freevoxels {

void BackgroundWriter::start(std::function<void()> write) {
  finish();
  running_ = std::async(std::launch::async, [write = std::move(write)] {
    std::vector<StageTime> times;
    {
      const StageTimer timer(times, "write images");
      write();
    }
    return times;
  });
}

void BackgroundWriter::finish() {
  if (running_.valid()) addTimes(times_, running_.get());
}

}  // namespace freevoxels
