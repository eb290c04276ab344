#pragma once
// Cameras on a circle around a subject, for turntables: frame i of N is i/N of a full turn past frame 0.

#include <vector>

#include "engine/scene/camera.h"

namespace freevoxels {

/// The framingCamera of each azimuth `azimuth` + 360 i / frames, but all with the same distance or
/// orthographic height: the largest that any of them needs, so that the subject is never cut off and its size
/// does not change. A single frame equals framingCamera.
std::vector<Camera> framingOrbit(const Subject& subject, double azimuth, double elevation, int frames, double aspect,
                                 const Camera& base);

/// `start`, which must pass checkCamera, turned about the axis through its look-at point along its `up`, in
/// the direction of growing azimuth. Frame 0 is `start`.
std::vector<Camera> orbitAboutUp(const Camera& start, int frames);

}  // namespace freevoxels
