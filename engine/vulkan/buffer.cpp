#include "engine/vulkan/buffer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <future>

#include "engine/core/error.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

namespace {

constexpr VkDeviceSize kStagingBytes = VkDeviceSize(32) << 20;
constexpr VkMemoryPropertyFlags kVisible =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

/// Index of the memory type for `use` among `allowedTypes`: the first type that has the preferred properties,
/// in the order of preference.
std::uint32_t findMemoryType(const Device& device, std::uint32_t allowedTypes, MemoryUse use) {
  std::array<VkMemoryPropertyFlags, 2> wishes{};
  switch (use) {
    case MemoryUse::Device:
      wishes = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
      break;
    case MemoryUse::Upload:
      wishes = {kVisible, kVisible};
      break;
    case MemoryUse::Readback:
      wishes = {kVisible | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, kVisible};
      break;
  }
  const VkPhysicalDeviceMemoryProperties& memory = device.memory();
  for (VkMemoryPropertyFlags wish : wishes)
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i)
      if ((allowedTypes >> i & 1u) && (memory.memoryTypes[i].propertyFlags & wish) == wish) return i;
  fail(ErrorKind::Device, "the device has no suitable memory type: choose another with {}", Parameter("device"));
}

}  // namespace

DeviceMemory::DeviceMemory(const Device& device, const VkMemoryRequirements& needs, MemoryUse use,
                           bool deviceAddress)
    : claim_(device, needs.size) {
  const std::uint32_t type = findMemoryType(device, needs.memoryTypeBits, use);
  const VkMemoryAllocateFlagsInfo flags{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                        .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .pNext = deviceAddress ? &flags : nullptr,
                                  .allocationSize = needs.size,
                                  .memoryTypeIndex = type};
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VK_CHECK(vkAllocateMemory(device.handle(), &info, nullptr, &memory));
  memory_ = OwnedMemory(device.handle(), memory);
  properties_ = device.memory().memoryTypes[type].propertyFlags;
}

Buffer::Buffer(const Device& device, VkDeviceSize bytes, MemoryUse use, const char* name,
               VkBufferUsageFlags extra)
    : bytes_(bytes) {
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                .size = bytes,
                                .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                         VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | extra};
  VkBuffer buffer = VK_NULL_HANDLE;
  VK_CHECK(vkCreateBuffer(device.handle(), &info, nullptr, &buffer));
  buffer_ = OwnedBuffer(device.handle(), buffer);
  device.setName(VK_OBJECT_TYPE_BUFFER, std::uint64_t(buffer), name);

  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device.handle(), buffer, &needs);
  memory_ = DeviceMemory(device, needs, use, true);
  VK_CHECK(vkBindBufferMemory(device.handle(), buffer, memory_.get(), 0));
  if (memory_.hostCoherent() && (use != MemoryUse::Device || device.mapsOwnMemory())) {
    void* mapped = nullptr;
    VK_CHECK(vkMapMemory(device.handle(), memory_.get(), 0, VK_WHOLE_SIZE, 0, &mapped));
    mapped_ = static_cast<std::byte*>(mapped);
  }
  const VkBufferDeviceAddressInfo address{.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
                                          .buffer = buffer};
  address_ = vkGetBufferDeviceAddress(device.handle(), &address);
}

TexelView::TexelView(const Device& device, const Buffer& buffer, VkFormat format, VkDeviceSize bytes) {
  const VkBufferViewCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO, .buffer = buffer.handle(), .format = format, .range = bytes};
  VkBufferView view = VK_NULL_HANDLE;
  VK_CHECK(vkCreateBufferView(device.handle(), &info, nullptr, &view));
  view_ = OwnedBufferView(device.handle(), view);
}

namespace {

/// Two buffers through which data are copied in pieces: the device copies one piece while the host copies another. Data of one piece need
/// one buffer and no thread.
class StagingHalves {
 public:
  StagingHalves(const Device& device, MemoryUse use, VkDeviceSize bytes)
      : device_(device), use_(use), pieceBytes_(std::min(kStagingBytes / 2, bytes)), isOnePiece_(pieceBytes_ == bytes) {}

  VkDeviceSize pieceBytes() const { return pieceBytes_; }
  /// The half that no copy uses, if no more than one copy was begun since the last finishCopy().
  const Buffer& next() {
    Buffer& half = halves_[taken_++ % 2];
    if (half.bytes() == 0) half = Buffer(device_, pieceBytes_, use_, "staging");
    return half;
  }
  void beginCopy(const Buffer& from, const Buffer& to, VkBufferCopy region) {
    copying_ = std::async(isOnePiece_ ? std::launch::deferred : std::launch::async, [this, &from, &to, region] {
      Commands commands(device_);
      commands.copy(from, to, region);
      commands.submitAndWait();
    });
  }
  /// Waits for the copy that was begun last, if there is one, and throws what it threw.
  void finishCopy() {
    if (copying_.valid()) copying_.get();
  }

 private:
  const Device& device_;
  const MemoryUse use_;
  const VkDeviceSize pieceBytes_;
  const bool isOnePiece_;
  std::array<Buffer, 2> halves_;
  std::size_t taken_ = 0;
  std::future<void> copying_;  // is destroyed, and waits, before the halves
};

}  // namespace

void upload(const Device& device, const Buffer& buffer, std::span<const std::byte> data) {
  upload(device, buffer, data.size(),
         [&](std::span<std::byte> piece, VkDeviceSize first) { std::memcpy(piece.data(), data.data() + first, piece.size()); });
}

void upload(const Device& device, const Buffer& buffer, VkDeviceSize bytes,
            const std::function<void(std::span<std::byte> piece, VkDeviceSize first)>& make) {
  static_assert(kStagingBytes % (2 << 16) == 0);
  FV_CHECK_LE(bytes, buffer.bytes());
  if (bytes == 0) return;
  if (buffer.mapped() != nullptr) return make({buffer.mapped(), bytes}, 0);
  StagingHalves staging(device, MemoryUse::Upload, bytes);
  for (VkDeviceSize done = 0; done < bytes; done += staging.pieceBytes()) {
    const Buffer& half = staging.next();
    const VkDeviceSize size = std::min(staging.pieceBytes(), bytes - done);
    make({half.mapped(), size}, done);
    staging.finishCopy();
    staging.beginCopy(half, buffer, {.srcOffset = 0, .dstOffset = done, .size = size});
  }
  staging.finishCopy();
}

bool growBuffer(const Device& device, Buffer& buffer, VkDeviceSize bytes, const char* name, VkBufferUsageFlags usage) {
  if (buffer.bytes() >= bytes) return false;
  buffer = {};  // free the old buffer before allocating the new one
  buffer = Buffer(device, bytes, MemoryUse::Device, name, usage);
  return true;
}

void download(const Device& device, const Buffer& buffer, std::span<std::byte> data, VkDeviceSize first) {
  FV_CHECK_LE(first + data.size(), buffer.bytes());
  if (data.empty()) return;
  if (buffer.readable() != nullptr) {
    std::memcpy(data.data(), buffer.readable() + first, data.size());
    return;
  }
  StagingHalves staging(device, MemoryUse::Readback, data.size());
  const auto sizeAt = [&](VkDeviceSize done) { return std::min(staging.pieceBytes(), data.size() - done); };
  const auto beginPiece = [&](VkDeviceSize done) {
    const Buffer& half = staging.next();
    staging.beginCopy(buffer, half, {.srcOffset = first + done, .dstOffset = 0, .size = sizeAt(done)});
    return &half;
  };
  const Buffer* half = beginPiece(0);
  for (VkDeviceSize done = 0; done < data.size();) {
    staging.finishCopy();
    const VkDeviceSize next = done + sizeAt(done);
    const Buffer* const nextHalf = next < data.size() ? beginPiece(next) : nullptr;
    std::memcpy(data.data() + done, half->mapped(), sizeAt(done));
    done = next;
    half = nextHalf;
  }
}

std::pair<Buffer, TexelView> uploadTexels(const Device& device, std::span<const std::byte> data, VkFormat format, const char* name) {
  Buffer buffer(device, data.size(), MemoryUse::Device, name, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  upload(device, buffer, data);
  TexelView view(device, buffer, format);
  return {std::move(buffer), std::move(view)};
}

}  // namespace freevoxels
