// The Vulkan layer: device choice, buffers, and that validation is listening.

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

#include "engine/core/error.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"
#include "tests/device/device_fixture.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

using VulkanTest = DeviceTest;

TEST_F(VulkanTest, ListsDevicesAndChoosesByIndexNameAndUuid) {
  const std::vector<DeviceDescription> devices = listDevices(instance());
  ASSERT_FALSE(devices.empty());
  const DeviceDescription& chosen = device().description();
  EXPECT_TRUE(chosen.rejections.empty());
  EXPECT_EQ(chosen.uuid.size(), 36u);
  for (const std::string& selector : {std::to_string(chosen.index), chosen.name, chosen.uuid})
    EXPECT_EQ(Device(instance(), selector).description().uuid, chosen.uuid);
}

TEST_F(VulkanTest, UnknownDeviceIsADeviceError) {
  try {
    const Device none(instance(), "no such device");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Device);
  }
}

TEST_F(VulkanTest, UploadAndDownloadReturnTheSameBytes) {
  std::vector<std::uint32_t> data(100'003);
  std::iota(data.begin(), data.end(), 17u);
  for (MemoryUse use : {MemoryUse::Device, MemoryUse::Upload, MemoryUse::Readback}) {
    const Buffer buffer(device(), data.size() * sizeof(std::uint32_t), use, "test");
    EXPECT_EQ(buffer.mapped() != nullptr, use != MemoryUse::Device);
    upload(device(), buffer, std::as_bytes(std::span(data)));
    upload(device(), buffer, {});
    std::vector<std::uint32_t> back(data.size());
    download(device(), buffer, std::as_writable_bytes(std::span(back)));
    EXPECT_EQ(data, back);
    std::uint32_t last = 0;
    download(device(), buffer, std::as_writable_bytes(std::span(&last, 1)), buffer.bytes() - sizeof(last));
    EXPECT_EQ(last, data.back());
  }
}

TEST_F(VulkanTest, UploadAndDownloadInSeveralPiecesReturnTheSameBytes) {
  std::vector<std::uint32_t> data(std::size_t(13) << 20 | 5);  // 52 MiB and 20 bytes
  std::iota(data.begin(), data.end(), 17u);
  const Buffer buffer(device(), data.size() * sizeof(std::uint32_t), MemoryUse::Device, "test");
  ASSERT_EQ(buffer.mapped(), nullptr);
  upload(device(), buffer, std::as_bytes(std::span(data)));
  std::vector<std::uint32_t> back(data.size() - 3);
  download(device(), buffer, std::as_writable_bytes(std::span(back)), 3 * sizeof(std::uint32_t));
  EXPECT_TRUE(std::ranges::equal(back, std::span(data).subspan(3)));
}

TEST_F(VulkanTest, PassesAreTimed) {
  Commands commands(device());
  const Buffer from(device(), 1 << 20, MemoryUse::Device, "from"),
      to(device(), 1 << 20, MemoryUse::Device, "to");
  commands.beginPass("first");
  commands.copy(from, to, {.size = from.bytes()});
  commands.beginPass("second");
  commands.copy(to, from, {.size = from.bytes()});
  commands.submitAndWait();
  const std::vector<StageTime> times = commands.times();
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0].name, "first");
  EXPECT_GT(times[0].milliseconds + times[1].milliseconds, 0.0);
}

TEST(Timestamps, StartAgainFromZero) {
  EXPECT_EQ(ticksBetween(100, 350, 64), 250u);
  EXPECT_EQ(ticksBetween((std::uint64_t(1) << 36) - 100, 150, 36), 250u);
  EXPECT_EQ(ticksBetween(~std::uint64_t(0) - 99, 150, 64), 250u);
}

TEST_F(VulkanTest, WithoutPassesThereIsNoProgress) {
  const Buffer buffer(device(), 1 << 26, MemoryUse::Device, "test");
  Commands commands(device());
  for (int i = 0; i < 16; ++i) commands.clear(buffer);
  commands.submitAndWait([](std::string_view, double) { ADD_FAILURE() << "of what?"; });
  EXPECT_TRUE(commands.times().empty());
}

/// Mesa's lavapipe of version 25 takes memory when it is first used, and refuses no size.
bool allocatesAnySize(const Device& device, VkDeviceSize size) {
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = size};
  VkDeviceMemory memory = VK_NULL_HANDLE;
  if (vkAllocateMemory(device.handle(), &info, nullptr, &memory) != VK_SUCCESS) return false;
  vkFreeMemory(device.handle(), memory, nullptr);
  return true;
}

/// Without validation, which would not let the device be asked.
TEST(Memory, WhatCouldNotBeAllocatedIsNotCounted) {
  const Instance instance(false);
  const Device device(instance, "");
  const std::uint64_t available = device.availableBytes();
  const VkMemoryRequirements tooMuch{.size = VkDeviceSize(1) << 60, .alignment = 256, .memoryTypeBits = ~0u};
  if (allocatesAnySize(device, tooMuch.size)) GTEST_SKIP() << "the driver refuses no size";
  const auto allocate = [&] { DeviceMemory(device, tooMuch, MemoryUse::Device, false); };
  test::expectRefusal(allocate, ErrorKind::OutOfMemory, {"the device is out of memory"});
  EXPECT_EQ(device.availableBytes(), available);
}

TEST(Validation, NoticesAMistake) {
  Instance instance(true);
  const Device device(instance, "");
  VkBufferCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = 0, .usage = 0};  // both invalid
  VkBuffer buffer = VK_NULL_HANDLE;
  if (vkCreateBuffer(device.handle(), &info, nullptr, &buffer) == VK_SUCCESS)
    vkDestroyBuffer(device.handle(), buffer, nullptr);
  EXPECT_GT(instance.validationMessageCount(), 0u);
}

TEST_F(VulkanTest, DevicesOfAProcessShareTheMemoryOfThePhysicalDevice) {
  const Device other(instance(), std::to_string(device().description().index));
  const std::uint64_t before = other.availableBytes(), limited = 1 << 20;
  const Device small(instance(), std::to_string(device().description().index), {.memory = limited});
  const Buffer buffer(device(), 3 << 20, MemoryUse::Device, "taken");
  EXPECT_LE(other.availableBytes(), before - (3 << 20));
  EXPECT_EQ(small.availableBytes(), limited) << "its limit counts its own allocations";
}

TEST(Validation, NoticesAMissingBarrier) {
  Instance instance(true);
  const Device device(instance, "");
  const Buffer a(device, 1024, MemoryUse::Device, "a"), b(device, 1024, MemoryUse::Device, "b");
  Commands commands(device);
  const VkBufferCopy region{.size = 1024};
  vkCmdCopyBuffer(commands.handle(), a.handle(), b.handle(), 1, &region);
  vkCmdCopyBuffer(commands.handle(), b.handle(), a.handle(), 1,
                  &region);  // reads what the first may still write
  commands.submitAndWait();
  EXPECT_GT(instance.validationMessageCount(), 0u);
}

}  // namespace
}  // namespace freevoxels
