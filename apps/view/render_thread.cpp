#include "apps/view/render_thread.h"

#include <utility>

#include "apps/common/failure.h"

namespace freevoxels {

namespace {

struct Abandoned {};

/// Before, nobody could read what is being done.
constexpr std::chrono::milliseconds kWorthSaying{250};

/// Makes images, and beside them those of another method.
class Makers {
 public:
  Makers(const Device& device, VolumeCache& volumes) : device_(device), volumes_(volumes) {}

  std::shared_ptr<const DrawnImage> make(const ImageRequest& request, const Progress& progress) {
    auto drawn = std::make_shared<DrawnImage>(makerOf(maker_).make(request, progress));
    if (!request.compared) {
      comparing_ = nullptr;
      return drawn;
    }
    ImageRequest other = request;
    other.scene.method = *request.compared;
    if (other.scene.method.drawing() == Draw::Splats) other.scene.camera.holdout.reset();
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

 private:
  ImageMaker& makerOf(std::unique_ptr<ImageMaker>& maker) const {
    if (!maker) maker = std::make_unique<ImageMaker>(device_, volumes_);
    return *maker;
  }

  const Device& device_;
  VolumeCache& volumes_;
  std::unique_ptr<ImageMaker> maker_;
  std::unique_ptr<ImageMaker> comparing_;  ///< for methods with another table
};

}  // namespace

RenderThread::RenderThread(const Device& device, VolumeCache& volumes, std::function<void()> finished)
    : RenderThread(
          [makers = std::make_shared<Makers>(device, volumes)](const ImageRequest& request, const Progress& progress) {
            return makers->make(request, progress);
          },
          std::move(finished)) {}

RenderThread::RenderThread(Make make, std::function<void()> finished)
    : make_(std::move(make)), finished_(std::move(finished)), thread_([this] { run(); }) {}

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
  result_.reset();
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

/// Nothing where its progress found that it is abandoned.
std::optional<RenderThread::Result> RenderThread::answer(const ImageRequest& request) {
  const Progress progress = [this](std::string_view stage, double fraction) {
    const std::lock_guard lock(mutex_);
    if (ends_ || abandons_) throw Abandoned();
    activity_.emplace(std::string(stage), fraction);
  };
  Result result{.number = request.number};
  try {
    result.drawn = make_(request, progress);
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
    if (result && !abandons_ && !ends_) result_ = std::move(result);
    activity_.reset();
    lock.unlock();
    finished_();
    lock.lock();
  }
}

}  // namespace freevoxels
