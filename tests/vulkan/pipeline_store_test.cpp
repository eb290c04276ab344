// Pipelines that are compiled by other threads, with compilers that need no device.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <latch>
#include <stdexcept>
#include <thread>

#include "engine/vulkan/pipeline.h"

namespace freevoxels {
namespace {

PipelineLayout withoutLayout() {
  return {};
}

PipelineKey keyOf(std::uint32_t number) {
  return {.constants = {number}};
}

TEST(PipelineStore, CompilesAPipelineOnceForAllThreadsThatNeedIt) {
  std::atomic<int> compiled = 0;
  const PipelineStore::Compiler compile = [&](VkPipelineCache, VkPipelineLayout) {
    ++compiled;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return OwnedPipeline();
  };
  PipelineStore store(VK_NULL_HANDLE, {});
  std::array<std::thread, 4> threads;
  for (std::thread& thread : threads) thread = std::thread([&] { store.get(keyOf(1), withoutLayout, compile).handle(); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(compiled, 1);
  store.get(keyOf(2), withoutLayout, compile).handle();
  EXPECT_EQ(compiled, 2) << "another key";
}

TEST(PipelineStore, CompilesBeforeAPipelineIsNeeded) {
  std::latch compiled(1);
  PipelineStore store(VK_NULL_HANDLE, {});
  const Pipeline pipeline = store.get(keyOf(1), withoutLayout, [&](VkPipelineCache, VkPipelineLayout) {
    compiled.count_down();
    return OwnedPipeline();
  });
  compiled.wait();
  EXPECT_TRUE(pipeline.exists());
}

TEST(PipelineStore, ACompilationThatFailsThrowsToWhoNeedsItAndIsTriedAgain) {
  std::atomic<bool> fails = true;
  PipelineStore store(VK_NULL_HANDLE, {});
  const Pipeline pipeline = store.get(keyOf(1), withoutLayout, [&](VkPipelineCache, VkPipelineLayout) -> OwnedPipeline {
    if (fails) throw std::runtime_error("no memory");
    return {};
  });
  EXPECT_THROW(pipeline.handle(), std::runtime_error);
  EXPECT_THROW(pipeline.handle(), std::runtime_error);
  fails = false;
  EXPECT_NO_THROW(pipeline.handle());
}

TEST(PipelineStore, EndsAfterWhatItCompiles) {
  std::latch begun(1);
  std::atomic<bool> ended = false;
  {
    PipelineStore store(VK_NULL_HANDLE, {});
    store.get(keyOf(1), withoutLayout, [&](VkPipelineCache, VkPipelineLayout) {
      begun.count_down();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      ended = true;
      return OwnedPipeline();
    });
    begun.wait();
  }
  EXPECT_TRUE(ended);
}

}  // namespace
}  // namespace freevoxels
