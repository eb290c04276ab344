#pragma once
// Reads a render target back to the host.

#include <cstdint>
#include <cstring>
#include <vector>

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/image.h"

namespace freevoxels {

/// Records the copy of a target into a read-back buffer with the frame; `read` returns the pixels after the
/// frame is complete.
class TargetReadback {
 public:
  TargetReadback(const Device& device, Commands& commands, const RenderTarget& target)
      : buffer_(
            device,
            std::uint64_t(target.size().x) * std::uint64_t(target.size().y) * bytesPerPixel(target.format()),
            MemoryUse::Readback, "picture") {
    commands.copy(target, buffer_);
  }
  template <typename Pixel>
  std::vector<Pixel> read() const {
    std::vector<Pixel> pixels(buffer_.bytes() / sizeof(Pixel));
    std::memcpy(pixels.data(), buffer_.mapped(), buffer_.bytes());
    return pixels;
  }

 private:
  Buffer buffer_;
};

}  // namespace freevoxels
