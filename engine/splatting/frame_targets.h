#pragma once
// The images that a frame is drawn into.

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/image/image.h"
#include "engine/scene/render_settings.h"
#include "engine/vulkan/image.h"

namespace freevoxels {

constexpr VkFormat kTargetColorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kTargetScalarFormat = VK_FORMAT_R32_SFLOAT;

/// The sums of a frame: C and E, T, and where depth is asked for, the sum of e times distance. Sorted:
/// premultiplied colour and alpha, and the distance blended like the colour. A frame that is complete has its image in
/// `colorEnergy`, linear premultiplied RGBA, and the mean distance in `distance`.
struct FrameTargets {
  RenderTarget colorEnergy;   ///< RGBA32F
  RenderTarget opticalDepth;  ///< R32F, or does not exist
  RenderTarget distance;      ///< R32F, or does not exist
  std::vector<const RenderTarget*> all() const;
};

enum class TargetKind {
  Sums,   ///< with T
  Image,  ///< of a frame that needs no sums at the pixels: without T
};

FrameTargets makeTargets(const Device& device, const FrameSettings& settings, TargetKind kind);
std::uint64_t targetBytes(const FrameSettings& settings);
/// Fails with ErrorKind::OutOfMemory where this device cannot hold such a frame: to be called before any other work.
void checkFrameFits(const Device& device, const FrameSettings& settings);

/// The image of a frame that was left on the device. Waits.
Image downloadImage(const Device& device, const FrameTargets& targets);

/// Keeps the targets of a renderer's frames, so that a frame allocates none while size and kind stay the same. For one
/// thread; what it has handed out may be released by another one, after the device has read it.
class TargetPool {
 public:
  /// Targets that nobody else holds, with undefined contents: kept ones, or new ones. They are the caller's as long as the
  /// pointer is kept. Frees kept ones of another size or kind.
  std::shared_ptr<const FrameTargets> take(const Device& device, const FrameSettings& settings, TargetKind kind);

 private:
  std::vector<std::shared_ptr<const FrameTargets>> kept_;
};

}  // namespace freevoxels
