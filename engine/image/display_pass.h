#pragma once
// A frame's image as a window shows it, without the host.

#include "engine/image/image.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/texture.h"

namespace freevoxels {

/// GRAPHICS display.vert, display.frag: exposure, tone map, background and sRGB, in a texture that has the bytes of srgbTexels().
class DisplayPass {
 public:
  explicit DisplayPass(const Device& device);

  /// `image` is RGBA32F, linear and premultiplied, in layout GENERAL and complete. `shown` has its size, and is ready to be
  /// sampled by fragment shaders behind this.
  void record(Commands& commands, const RenderTarget& image, const DisplayLook& look, const Texture& shown) const;

 private:
  const Device& device_;
  Buffer srgb_;  ///< srgbBuckets()
};

/// An image of the host for such a pass. Waits.
RenderTarget uploadImage(const Device& device, const Image& image);

}  // namespace freevoxels
