#include "apps/view/render_thread.h"

#include <utility>

#include "apps/view/failure.h"

namespace freevoxels {

namespace {

struct Ended {};

}  // namespace

RenderThread::RenderThread(const Instance& instance, const DeviceOptions& device, VolumeCache& volumes,
                           int mostVoxelsAlongEdge, std::function<void()> finished)
    : instance_(instance),
      deviceOptions_(device),
      volumes_(volumes),
      mostVoxelsAlongEdge_(mostVoxelsAlongEdge),
      finished_(std::move(finished)),
      device_(device.open(instance)),
      thread_([this] { run(); }) {}

RenderThread::~RenderThread() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  asked_.notify_one();
  thread_.join();
}

void RenderThread::ask(PictureRequest request) {
  {
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(request);
  }
  asked_.notify_one();
}

std::optional<RenderThread::Result> RenderThread::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(result_, std::nullopt);
}

std::optional<std::pair<std::string, double>> RenderThread::activity() const {
  const std::lock_guard lock(mutex_);
  return activity_;
}

RenderThread::Result RenderThread::answer(const PictureRequest& request) {
  const Progress progress = [this](std::string_view stage, double fraction) {
    const std::lock_guard lock(mutex_);
    if (ends_) throw Ended();
    activity_.emplace(std::string(stage), fraction);
  };
  Result result{.number = request.number};
  try {
    if (!device_) device_ = deviceOptions_.open(instance_);
    if (!maker_) maker_ = std::make_unique<PictureMaker>(*device_, volumes_, mostVoxelsAlongEdge_);
    result.picture = std::make_shared<const Picture>(maker_->make(request, progress));
  } catch (const Ended&) {  // nobody takes a result
  } catch (...) {
    const Failure failure = currentFailure();
    result.problem = failure.sentence;
    result.code = failure.code;
    if (failure.code == ExitCode::Device) {  // lost: the next request opens it again
      maker_ = nullptr;
      device_ = nullptr;
    }
  }
  return result;
}

void RenderThread::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    asked_.wait(lock, [this] { return ends_ || waiting_; });
    if (ends_) return;
    const PictureRequest request = *std::exchange(waiting_, std::nullopt);
    activity_.emplace("drawing", 0.0);
    lock.unlock();
    Result result = answer(request);
    lock.lock();
    result_ = std::move(result);
    activity_.reset();
    lock.unlock();
    finished_();
    lock.lock();
  }
}

}  // namespace freevoxels
