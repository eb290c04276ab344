#include "apps/common/background_writer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

#include "engine/core/error.h"

namespace freevoxels {
namespace {

TEST(BackgroundWriter, RunsBesideItsCallerOneWorkAtATime) {
  std::promise<void> drawn;
  std::atomic<int> written = 0;
  BackgroundWriter writer;
  writer.start([&] {
    drawn.get_future().wait();  // of what the caller does after start()
    ++written;
  });
  EXPECT_EQ(written, 0);
  drawn.set_value();
  writer.start([&] {
    EXPECT_EQ(written, 1) << "the work before is done";
    ++written;
  });
  writer.finish();
  EXPECT_EQ(written, 2);
  ASSERT_EQ(writer.times().size(), 1u) << "both are one stage";
  writer.finish();
}

TEST(BackgroundWriter, TheNextCallThrowsWhatTheWorkHasThrown) {
  BackgroundWriter writer;
  writer.start([] { fail(ErrorKind::Output, "no room for {}", "a.png"); });
  bool started = false;
  try {
    writer.start([&] { started = true; });
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Output);
    EXPECT_STREQ(error.what(), "no room for a.png");
  }
  writer.finish();
  EXPECT_FALSE(started);
}

}  // namespace
}  // namespace freevoxels
