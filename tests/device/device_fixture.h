#pragma once
// One device for all tests of a program, with the validation layer on; any message fails the test that caused
// it.

#include <gtest/gtest.h>

#include <cstdio>
#include <string_view>

#include "engine/vulkan/device.h"

namespace freevoxels {

class DeviceTest : public ::testing::Test {
 protected:
  static Instance& instance() {
    static Instance shared(true, [](std::string_view message) { std::fprintf(stderr, "%.*s\n", int(message.size()), message.data()); });
    return shared;
  }
  static Device& device() {
    static Device shared(instance(), "");
    return shared;
  }

  void SetUp() override { messagesBefore_ = instance().validationMessageCount(); }
  void TearDown() override { EXPECT_EQ(instance().validationMessageCount(), messagesBefore_); }

 private:
  std::uint64_t messagesBefore_ = 0;
};

}  // namespace freevoxels
