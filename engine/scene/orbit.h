#pragma once
// Cameras on a circle around what they look at, for a turntable: frame i of N is i/N of a turn past frame 0.

#include <vector>

#include "engine/scene/camera.h"

namespace freevoxels {

/// framingCamera from the azimuths `azimuth` + 360 i / frames, all from one distance and with one orthographic height: the
/// largest that any of them needs, so that nothing of the subject is ever cut and nothing seems to grow or shrink. One frame
/// is framingCamera's.
std::vector<Camera> framingOrbit(const Subject& subject, double azimuth, double elevation, int frames, double aspect,
                                 const Camera& base);

/// `start`, which checkCamera accepts, turned about the axis through its look-at point along its `up`, as azimuth turns.
/// Frame 0 is `start`.
std::vector<Camera> orbitAboutUp(const Camera& start, int frames);

}  // namespace freevoxels
