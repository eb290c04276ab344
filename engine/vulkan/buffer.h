#pragma once
// Device buffers, each with its own allocation in memory that suits its use.

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>

#include "engine/vulkan/device.h"
#include "engine/vulkan/owned.h"

namespace freevoxels {

enum class MemoryUse {
  Device,    ///< read and written by the device; also mapped if possible and Device::mapsOwnMemory
  Upload,    ///< written by the host, read once by the device
  Readback,  ///< written by the device, read by the host
};

/// Owns bytes of the device's memory budget until it is destroyed. The constructor fails with
/// ErrorKind::OutOfMemory if the limit would be exceeded.
class MemoryClaim {
 public:
  MemoryClaim() = default;
  MemoryClaim(const Device& device, std::uint64_t bytes) : device_(&device), bytes_(bytes) {
    device.claim(bytes);
  }
  MemoryClaim(MemoryClaim&& other) noexcept { *this = std::move(other); }
  MemoryClaim& operator=(MemoryClaim&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~MemoryClaim() {
    if (device_ != nullptr) device_->release(bytes_);
  }

 private:
  const Device* device_ = nullptr;
  std::uint64_t bytes_ = 0;
};

/// A device memory allocation, counted in its device's memory budget.
class DeviceMemory {
 public:
  DeviceMemory() = default;
  /// Allocates from the memory type that suits `use` best; `deviceAddress` makes the memory usable for buffer
  /// device addresses.
  DeviceMemory(const Device& device, const VkMemoryRequirements& needs, MemoryUse use, bool deviceAddress);
  VkDeviceMemory get() const { return memory_.get(); }
  /// Whether the memory can be mapped and needs no flushing.
  bool hostCoherent() const { return (properties_ & kHostCoherent) == kHostCoherent; }
  /// Whether, in addition, the host's reads are cached. Reads of other (write-combined) memory are slow.
  bool hostCached() const { return hostCoherent() && (properties_ & VK_MEMORY_PROPERTY_HOST_CACHED_BIT) != 0; }

 private:
  MemoryClaim claim_;  // until the memory is freed, or could not be allocated
  static constexpr VkMemoryPropertyFlags kHostCoherent =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  VkMemoryPropertyFlags properties_ = 0;
  OwnedMemory memory_;
};

class Buffer {
 public:
  Buffer() = default;
  /// Creates a buffer with storage, transfer and device-address usage, plus the usage `extra`. Debuggers show
  /// `name`.
  Buffer(const Device& device, VkDeviceSize bytes, MemoryUse use, const char* name,
         VkBufferUsageFlags extra = 0);

  VkBuffer handle() const { return buffer_.get(); }
  VkDeviceSize bytes() const { return bytes_; }
  VkDeviceAddress address() const { return address_; }
  /// The host address of the buffer's memory, or null if it is not mapped. Valid as long as the buffer.
  std::byte* mapped() const { return mapped_; }
  /// As mapped(), for reading: null as well if host reads are not cached, as a copy into MemoryUse::Readback is faster then.
  const std::byte* readable() const { return memory_.hostCached() ? mapped_ : nullptr; }

 private:
  DeviceMemory memory_;
  OwnedBuffer buffer_;
  VkDeviceSize bytes_ = 0;
  VkDeviceAddress address_ = 0;
  std::byte* mapped_ = nullptr;
};

/// Splits a device address into the low and high word that shaders take.
inline glm::uvec2 addressWords(VkDeviceAddress address) {
  return {std::uint32_t(address), std::uint32_t(address >> 32)};
}

/// A view of a buffer as texels. Loads go through the texture path, which lavapipe vectorises across lanes,
/// while storage-buffer loads go lane by lane: sweeps take two thirds of the time.
class TexelView {
 public:
  TexelView() = default;
  /// The buffer needs VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT.
  TexelView(const Device& device, const Buffer& buffer, VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT,
            VkDeviceSize bytes = VK_WHOLE_SIZE);
  VkBufferView handle() const { return view_.get(); }

 private:
  OwnedBufferView view_;
};

/// Copies host data into `buffer`: directly if it is mapped, otherwise in pieces through a staging buffer.
/// Blocks until the copy is complete.
void upload(const Device& device, const Buffer& buffer, std::span<const std::byte> data);
/// The same of `bytes` that `make(piece, first)` writes piece by piece, each of which begins at byte `first`, a multiple of 64 KiB.
void upload(const Device& device, const Buffer& buffer, VkDeviceSize bytes,
            const std::function<void(std::span<std::byte> piece, VkDeviceSize first)>& make);

/// Replaces a buffer that is smaller than `bytes`, whose contents are lost, by one of MemoryUse::Device. Returns whether it did.
bool growBuffer(const Device& device, Buffer& buffer, VkDeviceSize bytes, const char* name, VkBufferUsageFlags usage = 0);

/// Copies data.size() bytes of `buffer`, starting at byte `first`, to the host. Blocks until the copy is
/// complete.
void download(const Device& device, const Buffer& buffer, std::span<std::byte> data, VkDeviceSize first = 0);

/// A device buffer that holds `data`, and its view as texels of `format`.
std::pair<Buffer, TexelView> uploadTexels(const Device& device, std::span<const std::byte> data, VkFormat format, const char* name);

}  // namespace freevoxels
