#include <gtest/gtest.h>

#include <csignal>
#include <future>
#include <optional>

#include "apps/common/program.h"

namespace freevoxels {
namespace {

volatile std::sig_atomic_t heard = 0;

/// As two threads have them that write at the same time, in either order.
TEST(DeferredInterrupts, LastUntilTheLastOneEnds) {
  const auto before = std::signal(SIGTERM, [](int) { heard = heard + 1; });
  for (const bool firstEndsFirst : {true, false}) {
    heard = 0;
    std::optional<DeferredInterrupts> first, second;
    first.emplace();
    second.emplace();
    (firstEndsFirst ? first : second).reset();
    std::raise(SIGTERM);
    EXPECT_EQ(heard, 0);
    (firstEndsFirst ? second : first).reset();
    EXPECT_EQ(heard, 1);
    std::raise(SIGTERM);
    EXPECT_EQ(heard, 2) << "as it was before";
  }
  std::signal(SIGTERM, before);
}

TEST(DeferredInterrupts, OfOtherThreadsDoNotBeginOnceASignalIsDeferred) {
  const auto before = std::signal(SIGTERM, [](int) { heard = heard + 1; });
  heard = 0;
  std::optional<DeferredInterrupts> first;
  first.emplace();
  std::raise(SIGTERM);
  std::future<int> heardBefore = std::async(std::launch::async, [] {
    const DeferredInterrupts next;
    return int(heard);
  });
  { const DeferredInterrupts another; }  // of the same thread, which waits for nothing
  EXPECT_EQ(heard, 0);
  first.reset();
  EXPECT_EQ(heardBefore.get(), 1);
  std::signal(SIGTERM, before);
}

}  // namespace
}  // namespace freevoxels
