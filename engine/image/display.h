#pragma once
// How linear light becomes the samples of an image to look at: exposure, tone map, background, sRGB curve.

#include <vector>

#include "engine/image/image.h"

namespace freevoxels {

/// Samples of a pixel: red, green and blue over a background; straight alpha beside them without one.
inline int displayChannels(const DisplayLook& look) {
  return look.background ? 3 : 4;
}

/// displayChannels(look) samples a pixel, from 0 to the largest that `Sample` holds, rounded to nearest; row 0 is the top.
/// `Sample` is std::uint8_t or std::uint16_t.
template <typename Sample>
std::vector<Sample> displaySamples(const Image& image, const DisplayLook& look);

}  // namespace freevoxels
