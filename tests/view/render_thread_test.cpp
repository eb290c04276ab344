#include "apps/view/render_thread.h"

#include <condition_variable>
#include <mutex>

#include "tests/device/device_fixture.h"

namespace freevoxels {
namespace {

class RenderThreadTest : public DeviceTest {
 protected:
  static ImageRequest request(std::uint64_t number, int size) {
    ImageRequest request;
    request.scene.input = {.volume = "procedural:cloud", .grid = std::nullopt, .resolution = glm::ivec3(48)};
    request.scene.camera.size = {size, size};
    request.number = number;
    return request;
  }
  void waitForFinish(int times) {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(changed_.wait_for(lock, std::chrono::seconds(60), [&] { return finished_ >= times; }));
  }
  /// Until an image is being made, unless it is complete already.
  void waitForDrawing(int finishedBefore) {
    const auto isFinished = [&] {
      const std::lock_guard lock(mutex_);
      return finished_ > finishedBefore;
    };
    while (thread_.busyFor() == std::chrono::milliseconds(0) && !isFinished()) std::this_thread::yield();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  int finished_ = 0;
  VolumeCache volumes_{1u << 30};
  RenderThread thread_{device(), volumes_, [this] {
                         const std::lock_guard lock(mutex_);
                         ++finished_;
                         changed_.notify_all();
                       }};
};

TEST_F(RenderThreadTest, AnAbandonedImageHasNoResultAndTheNextOneIsAsIfItWereTheFirst) {
  for (int round = 0; round < 4; ++round) {  // abandoned at different places
    thread_.ask(request(1, 900));
    waitForDrawing(2 * round);
    std::this_thread::sleep_for(std::chrono::milliseconds(40 * round));
    thread_.abandon();
    waitForFinish(2 * round + 1);
    const std::optional<RenderThread::Result> abandoned = thread_.take();
    EXPECT_FALSE(abandoned);
    thread_.ask(request(2, 64));
    waitForFinish(2 * round + 2);
    const std::optional<RenderThread::Result> next = thread_.take();
    ASSERT_TRUE(next && next->drawn) << (next ? next->problem : "no result");
    EXPECT_EQ(next->number, 2u);
    VolumeCache volumes(1u << 30);
    const DrawnImage expected = ImageMaker(device(), volumes).make(request(2, 64), {});
    EXPECT_EQ(downloadImage(device(), *next->drawn->image).pixels, downloadImage(device(), *expected.image).pixels);
  }
}

TEST_F(RenderThreadTest, WhatWaitsIsAbandonedToo) {
  thread_.ask(request(1, 64));
  thread_.ask(request(2, 64));
  waitForDrawing(0);
  thread_.abandon();
  thread_.ask(request(3, 32));
  std::optional<RenderThread::Result> last;
  for (int times = 1; !last || last->number != 3; ++times) {
    waitForFinish(times);
    last = thread_.take();
    ASSERT_LT(times, 4);
  }
  EXPECT_EQ(last->drawn->shown->size(), glm::ivec2(32));
}

/// A thread whose images end when the test says so, without another look at whether they are abandoned.
class StubbornImages : public testing::Test {
 protected:
  ~StubbornImages() override {
    const std::lock_guard lock(mutex_);
    released_ = begun_ + 1;
    changed_.notify_all();
  }
  std::shared_ptr<const DrawnImage> make(const ImageRequest& request) {
    std::unique_lock lock(mutex_);
    ++begun_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return released_ >= begun_; });
    if (fails_) throw std::runtime_error("no image");
    return std::make_shared<DrawnImage>(DrawnImage{.request = request});
  }
  void ask(std::uint64_t number) {
    ImageRequest request;
    request.number = number;
    thread_.ask(request);
    wait([this] { return begun_ == released_ + 1; });
  }
  void endImage() {
    {
      const std::lock_guard lock(mutex_);
      ++released_;
      changed_.notify_all();
    }
    wait([this] { return finished_ == released_; });
  }
  template <typename Condition>
  void wait(const Condition& condition) {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(changed_.wait_for(lock, std::chrono::seconds(60), condition));
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  int begun_ = 0, released_ = 0, finished_ = 0;
  bool fails_ = false;
  RenderThread thread_{[this](const ImageRequest& request, const Progress&) { return make(request); }, [this] {
                         const std::lock_guard lock(mutex_);
                         ++finished_;
                         changed_.notify_all();
                       }};
};

TEST_F(StubbornImages, AnImageOrAFailureThatEndsAfterItWasAbandonedIsNoResult) {
  for (const bool fails : {false, true}) {
    fails_ = fails;
    ask(1);
    thread_.abandon();
    endImage();
    EXPECT_FALSE(thread_.take());
    ask(2);
    endImage();
    const std::optional<RenderThread::Result> next = thread_.take();
    ASSERT_TRUE(next);
    EXPECT_EQ(next->number, 2u);
    EXPECT_EQ(next->drawn == nullptr, fails);
  }
}

TEST_F(StubbornImages, AnImageThatWasMadeAndNotTakenIsAbandonedToo) {
  ask(1);
  endImage();
  thread_.abandon();
  EXPECT_FALSE(thread_.take());
}

TEST_F(StubbornImages, NothingComesAfterTheEnd) {
  ask(1);
  thread_.end();
  endImage();
  EXPECT_FALSE(thread_.take());
}

}  // namespace
}  // namespace freevoxels
