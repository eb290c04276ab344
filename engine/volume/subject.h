#pragma once
// The part of a volume that an image is to show: its box, or the visible part.

#include "engine/scene/camera.h"
#include "engine/scene/orbit.h"
#include "engine/volume/classification.h"

namespace freevoxels {

/// The corners of the volume's box, faces of the outermost voxels included.
Subject boxOf(const Volume& volume);

/// A camera that shows the volume's box (scene/camera.h).
inline Camera framingCamera(const Volume& volume, double azimuth, double elevation, double aspect, const Camera& base) {
  return framingCamera(boxOf(volume), azimuth, elevation, aspect, base);
}

/// Cameras of a turntable that show the volume's box (scene/orbit.h).
inline std::vector<Camera> framingOrbit(const Volume& volume, double azimuth, double elevation, int frames, double aspect,
                                        const Camera& base) {
  return framingOrbit(boxOf(volume), azimuth, elevation, frames, aspect, base);
}

/// The visible parts of the volume, in cells of 1/64 of its longest side: cells with extinction or emission,
/// except for densities below 1/256 of the largest. The whole box if there are none.
Subject contentOf(const Volume& volume, const Classification& classification);

}  // namespace freevoxels
