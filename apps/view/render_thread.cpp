#include "apps/view/render_thread.h"

#include <utility>

#include "apps/freevoxels/failure.h"

namespace freevoxels {

namespace {

struct Abandoned {};

/// Before, nobody could read what is being done.
constexpr std::chrono::milliseconds kWorthSaying{250};

}  // namespace

RenderThread::RenderThread(const Device& device, VolumeCache& volumes, std::function<void()> finished)
    : device_(device), volumes_(volumes), finished_(std::move(finished)), thread_([this] { run(); }) {}

RenderThread::~RenderThread() {
  end();
  thread_.join();
}

void RenderThread::end() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  asked_.notify_one();
}

bool RenderThread::isBusy() const {
  const std::lock_guard lock(mutex_);
  return busy_;
}

void RenderThread::ask(ImageRequest request) {
  {
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(request);
  }
  asked_.notify_one();
}

void RenderThread::abandon() {
  const std::lock_guard lock(mutex_);
  waiting_.reset();
  abandons_ = busy_;
}

std::chrono::milliseconds RenderThread::busyFor() const {
  const std::lock_guard lock(mutex_);
  if (!busy_) return {};
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begun_);
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

std::shared_ptr<const DrawnImage> RenderThread::makeImage(const ImageRequest& request) {
  const Progress progress = [this](std::string_view stage, double fraction) {
    const std::lock_guard lock(mutex_);
    if (ends_ || abandons_) throw Abandoned();
    activity_.emplace(std::string(stage), fraction);
  };
  const auto makerOf = [this](std::unique_ptr<ImageMaker>& maker) -> ImageMaker& {
    if (!maker) maker = std::make_unique<ImageMaker>(device_, volumes_);
    return *maker;
  };
  auto drawn = std::make_shared<DrawnImage>(makerOf(maker_).make(request, progress));
  if (!request.compared) {
    comparing_ = nullptr;
    return drawn;
  }
  ImageRequest other = request;
  other.scene.method = *request.compared;
  other.diagnosis = {};
  const auto tableOf = [](const ImageRequest& of) {
    const TableSettings table = of.scene.method.table();
    return std::tuple(table.code, table.pathLengthCorrection, table.directions, table.filter);
  };
  const bool sameTable = tableOf(other) == tableOf(request);
  DrawnImage compared = makerOf(sameTable ? maker_ : comparing_).make(other, progress);
  drawn->compared = std::move(compared.shown);
  drawn->milliseconds += compared.milliseconds;
  return drawn;
}

/// Nothing where it was abandoned.
std::optional<RenderThread::Result> RenderThread::answer(const ImageRequest& request) {
  Result result{.number = request.number};
  try {
    result.drawn = makeImage(request);
  } catch (const Abandoned&) {
    return std::nullopt;
  } catch (...) {
    result.problem = currentFailure().sentence;
    result.failure = std::current_exception();
  }
  return result;
}

void RenderThread::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    asked_.wait(lock, [this] { return ends_ || waiting_; });
    if (ends_) return;
    const ImageRequest request = *std::exchange(waiting_, std::nullopt);
    activity_.emplace("drawing", 0.0);
    busy_ = true;
    abandons_ = false;
    begun_ = std::chrono::steady_clock::now();
    lock.unlock();
    std::optional<Result> result = answer(request);
    lock.lock();
    busy_ = false;
    if (result) result_ = std::move(result);
    activity_.reset();
    lock.unlock();
    finished_();
    lock.lock();
  }
}

}  // namespace freevoxels
