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
    EXPECT_TRUE(!abandoned || abandoned->drawn) << "it was complete just before, or there is none";
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

}  // namespace
}  // namespace freevoxels
