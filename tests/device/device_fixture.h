#pragma once
// One device for all tests of a program, with the validation layer on; any message fails the test that caused
// it.

#include <gtest/gtest.h>

#include <cstdio>
#include <optional>
#include <string_view>

#include "engine/vulkan/device.h"

namespace freevoxels {

/// What all tests share, opened when it is first needed. Closed before the program ends, when the validation layers may have ended already.
class SharedDevice : public ::testing::Environment {
 public:
  Instance& instance() {
    if (!instance_)
      instance_.emplace(true, [](std::string_view message) { std::fprintf(stderr, "%.*s\n", int(message.size()), message.data()); });
    return *instance_;
  }
  Device& device() {
    if (!device_) device_.emplace(instance(), "");
    return *device_;
  }
  void TearDown() override {
    device_.reset();
    instance_.reset();
  }

 private:
  std::optional<Instance> instance_;
  std::optional<Device> device_;
};
inline SharedDevice& sharedDevice = *static_cast<SharedDevice*>(::testing::AddGlobalTestEnvironment(new SharedDevice));

class DeviceTest : public ::testing::Test {
 protected:
  static Instance& instance() { return sharedDevice.instance(); }
  static Device& device() { return sharedDevice.device(); }

  void SetUp() override { messagesBefore_ = instance().validationMessageCount(); }
  void TearDown() override { EXPECT_EQ(instance().validationMessageCount(), messagesBefore_); }

 private:
  std::uint64_t messagesBefore_ = 0;
};

}  // namespace freevoxels
