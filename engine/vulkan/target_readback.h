#pragma once
// Reads a render target back to the host.

#include <cstdint>
#include <vector>

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/image.h"

namespace freevoxels {

/// Copies a target to the host through a buffer, which it keeps for the next copy of the same size.
class TargetReadback {
 public:
  /// Records the copy of a target that is in layout GENERAL and visible to transfers; the layout stays.
  void record(const Device& device, Commands& commands, const RenderTarget& target) {
    const std::uint64_t bytes =
        std::uint64_t(target.size().x) * std::uint64_t(target.size().y) * bytesPerPixel(target.format());
    if (buffer_.bytes() != bytes) {
      buffer_ = {};  // not both at once
      buffer_ = Buffer(device, bytes, MemoryUse::Readback, "image on the host");
    }
    commands.copy(target, buffer_);
  }
  /// Returns the pixels row by row from the top. Only valid after the commands are complete.
  template <typename Pixel>
  std::vector<Pixel> read() const {
    const auto* const pixels = reinterpret_cast<const Pixel*>(buffer_.mapped());
    return {pixels, pixels + buffer_.bytes() / sizeof(Pixel)};
  }

 private:
  Buffer buffer_;
};

}  // namespace freevoxels
