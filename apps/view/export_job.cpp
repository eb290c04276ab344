#include "apps/view/export_job.h"

#include "apps/common/failure.h"

namespace freevoxels {

namespace {

struct Cancelled {};

}  // namespace

ExportJob::ExportJob(std::function<void()> finished) : finished_(std::move(finished)) {}

ExportJob::~ExportJob() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

bool ExportJob::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_;
}

std::optional<ExportJob::Outcome> ExportJob::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(outcome_, std::nullopt);
}

std::pair<std::string, double> ExportJob::activity() const {
  const std::lock_guard lock(mutex_);
  return activity_;
}

ExportJob::Outcome ExportJob::outcomeOf(const Work& work, const std::string& done) {
  const Progress progress = [this](std::string_view stage, double fraction) {
    if (cancelled_) throw Cancelled();
    const std::lock_guard lock(mutex_);
    activity_ = {std::string(stage), fraction};
  };
  try {
    work(progress);
    return {true, done};
  } catch (const Cancelled&) {
    return {.done = false, .sentence = "cancelled: images that were complete are there", .cancelled = true};
  } catch (...) {
    return {false, currentFailure().sentence};
  }
}

void ExportJob::start(Work work, std::string done) {
  FV_CHECK_EQ(busy(), false);
  if (thread_.joinable()) thread_.join();  // has ended
  cancelled_ = false;
  {
    const std::lock_guard lock(mutex_);
    busy_ = true;
    outcome_.reset();
    activity_ = {"writing", 0.0};
  }
  thread_ = std::thread([this, work = std::move(work), done = std::move(done)] {
    Outcome outcome = outcomeOf(work, done);
    {
      const std::lock_guard lock(mutex_);
      outcome_ = std::move(outcome);
      busy_ = false;
    }
    finished_();
  });
}

}  // namespace freevoxels
