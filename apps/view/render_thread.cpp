#include "apps/view/render_thread.h"

#include <utility>

#include "apps/freevoxels/failure.h"

namespace freevoxels {

namespace {

struct Ended {};

/// Before, nobody could read what is being done.
constexpr std::chrono::milliseconds kWorthSaying{250};

}  // namespace

RenderThread::RenderThread(const Instance& instance, const DeviceOptions& device, VolumeCache& volumes,
                           std::function<void()> finished)
    : instance_(instance),
      deviceOptions_(device),
      volumes_(volumes),
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
  if (std::chrono::steady_clock::now() - begun_ < kWorthSaying) return std::nullopt;
  return activity_;
}

std::shared_ptr<const Picture> RenderThread::makePicture(const PictureRequest& request) {
  const Progress progress = [this](std::string_view stage, double fraction) {
    const std::lock_guard lock(mutex_);
    if (ends_) throw Ended();
    activity_.emplace(std::string(stage), fraction);
  };
  if (!device_) device_ = deviceOptions_.open(instance_);
  const auto makerOf = [this](std::unique_ptr<PictureMaker>& maker) -> PictureMaker& {
    if (!maker) maker = std::make_unique<PictureMaker>(*device_, volumes_);
    return *maker;
  };
  auto picture = std::make_shared<Picture>(makerOf(maker_).make(request, progress));
  if (!request.compared) {
    comparing_ = nullptr;
    return picture;
  }
  PictureRequest other = request;
  other.method = *request.compared;
  other.diagnosis = {};
  const bool sameTable = tableText(other.method.table()) == tableText(request.method.table());
  Picture compared = makerOf(sameTable ? maker_ : comparing_).make(other, progress);
  picture->compared = std::move(compared.image);
  picture->milliseconds += compared.milliseconds;
  return picture;
}

RenderThread::Result RenderThread::answer(const PictureRequest& request) {
  Result result{.number = request.number};
  try {
    result.picture = makePicture(request);
  } catch (const Ended&) {  // nobody takes a result
  } catch (...) {
    const Failure failure = currentFailure();
    result.problem = failure.sentence;
    result.code = failure.code;
    if (failure.code == ExitCode::Device) {  // lost: the next request opens it again
      maker_ = nullptr;
      comparing_ = nullptr;
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
    begun_ = std::chrono::steady_clock::now();
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
