#pragma once
// What an .exr may hold beside colours and alpha (arbitrary output variables).

#include <string>

#include "engine/image/image.h"
#include "engine/scene/camera.h"

namespace freevoxels {

struct Aovs {
  bool depth = false;          ///< Z: mean distance along the viewing axis, in world units; +infinity where nothing is seen
  bool position = false;       ///< P.X, P.Y, P.Z: the point in the world at that depth; 0 where nothing is seen
  bool normal = false;         ///< N.X, N.Y, N.Z: unit normal, towards the eye, of the surface of these points; 0 like P
  bool transmittance = false;  ///< transmittance.Y: 1 - alpha, not below 0
  bool lights = false;         ///< light1.R, ..., a layer for each source of light (light_layers.h), of which the colours are the sum
  bool channels = false;       ///< a layer for each channel of the volume (channels.h), of which the colours are the sum

  bool any() const { return depth || position || normal || transmittance || lights || channels; }
  bool hasLayers() const { return lights || channels; }
  bool needDepth() const { return depth || position || normal; }

  bool operator==(const Aovs&) const = default;
};

/// Reads "depth,normal". ErrorKind::Usage where a word is none of the members; `name` is what the sentence calls the text.
Aovs readAovs(const std::string& name, const std::string& text);
/// What readAovs reads.
std::string aovText(const Aovs& aovs);

/// Makes the channels of a whole image that `camera` saw from its colours and its depth; without `aovs.depth` it loses that.
void addChannels(Image& image, const Aovs& aovs, const Camera& camera);

}  // namespace freevoxels
