#include "apps/common/background_writer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/error.h"

namespace freevoxels {
namespace {

/// Calls the action and expects an error with this sentence.
template <typename Action>
void expectError(const Action& action, const std::string& sentence) {
  try {
    action();
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Output);
    EXPECT_EQ(error.what(), sentence);
  }
}

TEST(BackgroundWriter, RunsTasksBesideItsCallerAndEachOther) {
  std::latch drawn(1), both(2);
  std::atomic<int> written = 0;
  BackgroundWriter writer({.threads = 2});
  for (int task = 0; task < 2; ++task)
    writer.start({.write = [&] {
      drawn.wait();  // for what the caller does after start()
      both.arrive_and_wait();
      ++written;
    }});
  EXPECT_EQ(written, 0);
  drawn.count_down();
  writer.finish();
  EXPECT_EQ(written, 2);
  ASSERT_EQ(writer.times().size(), 1u) << "both are one stage";
  writer.finish();
}

TEST(BackgroundWriter, SaysWhatIsWrittenInTheOrderOfStart) {
  std::latch secondIsDone(1);
  std::vector<int> written;
  BackgroundWriter writer({.threads = 2});
  writer.start({.write = [&] { secondIsDone.wait(); }}, [&] { written.push_back(1); });
  writer.start({.write = [&] { secondIsDone.count_down(); }}, [&] { written.push_back(2); });
  writer.finish();
  EXPECT_EQ(written, (std::vector{1, 2}));
}

TEST(BackgroundWriter, WaitsForTheFirstTaskWhereTheLimitsAllowNoMore) {
  constexpr std::uint64_t kBytes = 10;
  for (const WritingLimits& limits : {WritingLimits{.threads = 2, .bytes = 100}, WritingLimits{.threads = 9, .bytes = 2 * kBytes}}) {
    std::atomic<int> running = 0;
    int written = 0;
    const auto write = [&] {
      EXPECT_LE(++running, 2);
      --running;
    };
    BackgroundWriter writer(limits);
    for (int task = 1; task <= 20; ++task) {
      writer.start({.bytes = kBytes, .write = write}, [&] { ++written; });
      EXPECT_GE(written, task - 2);
    }
    writer.finish();
    EXPECT_EQ(written, 20);
  }
}

TEST(BackgroundWriter, RunsATaskLargerThanTheLimitAlone) {
  std::atomic<bool> isFirstDone = false;
  BackgroundWriter writer({.threads = 2, .bytes = 10});
  writer.start({.bytes = 5, .write = [&] { isFirstDone = true; }});
  writer.start({.bytes = 11, .write = [&] { EXPECT_TRUE(isFirstDone); }});
  writer.finish();
}

TEST(BackgroundWriter, FreesWhatATaskKeepsAsSoonAsItIsDone) {
  std::latch isFreed(1);
  BackgroundWriter writer;
  writer.start({.write = [image = std::shared_ptr<void>(nullptr, [&](void*) { isFreed.count_down(); })] {}});
  isFreed.wait();
  writer.finish();
}

TEST(BackgroundWriter, TheNextCallThrowsWhatTheTaskHasThrown) {
  BackgroundWriter writer({.threads = 1});
  writer.start({.write = [] { fail(ErrorKind::Output, "no room for {}", "a.png"); }});
  bool started = false;
  expectError([&] { writer.start({.write = [&] { started = true; }}); }, "no room for a.png");
  writer.finish();
  EXPECT_FALSE(started);
}

TEST(BackgroundWriter, ThrowsTheFirstExceptionAndSaysWhatIsWrittenBefore) {
  std::latch lastHasBegun(1);
  std::vector<int> written;
  BackgroundWriter writer({.threads = 3});
  writer.start({.write = [] {}}, [&] { written.push_back(1); });
  writer.start({.write =
                    [&] {
                      lastHasBegun.wait();
                      fail(ErrorKind::Output, "no room for b.png");
                    }},
               [&] { written.push_back(2); });
  const auto startLast = [&] {
    writer.start({.write =
                      [&] {
                        lastHasBegun.count_down();
                        fail(ErrorKind::Output, "no room for c.png");
                      }},
                 [&] { written.push_back(3); });
    writer.finish();
  };
  expectError(startLast, "no room for b.png");
  EXPECT_EQ(written, std::vector{1});
  expectError([&] { writer.finish(); }, "no room for c.png");
}

}  // namespace
}  // namespace freevoxels
