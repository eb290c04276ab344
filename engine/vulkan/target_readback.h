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
  void record(const Device& device, Commands& commands, const RenderTarget& target);
  /// Returns the pixels, glm::vec4 or float, row by row from the top. Only valid after the commands are complete.
  template <typename Pixel>
  std::vector<Pixel> read() const;

 private:
  Buffer buffer_;
};

}  // namespace freevoxels
