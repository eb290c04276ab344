#include "apps/common/background_writer.h"

#include <chrono>
#include <memory>
#include <utility>

namespace freevoxels {

void BackgroundWriter::start(WritingTask task, std::function<void()> written) {
  const auto firstIsDone = [this] { return running_.front().times.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
  while (!running_.empty() && (hasFailed_ || firstIsDone() || !allows(task.bytes))) completeFirst();

  // std::async moves from what it is given even if it finds no thread and keeps the task for later: it gets a copy.
  const auto write = std::make_shared<std::function<void()>>(std::move(task.write));
  const auto run = [this, write] {
    std::vector<StageTime> times;
    try {
      const StageTimer timer(times, "write images");
      std::exchange(*write, {})();  // also frees what it keeps
    } catch (...) {
      hasFailed_ = true;
      throw;
    }
    return times;
  };
  running_.push_back({task.bytes, std::move(written), std::async(std::launch::async | std::launch::deferred, run)});
  bytes_ += task.bytes;
}

void BackgroundWriter::finish() {
  while (!running_.empty()) completeFirst();
}

bool BackgroundWriter::allows(std::uint64_t bytes) const {
  return running_.size() < limits_.threads && bytes_ + bytes <= limits_.bytes;
}

void BackgroundWriter::completeFirst() {
  Running first = std::move(running_.front());
  running_.pop_front();
  bytes_ -= first.bytes;
  addTimes(times_, first.times.get());
  if (first.written) first.written();
}

}  // namespace freevoxels
