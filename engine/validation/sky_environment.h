#pragma once
// A procedural sky for lighting: brighter towards the horizon, with a sun, and dark ground.

#include "engine/scene/environment.h"

namespace freevoxels {

/// The position of makeSky's sun: degrees about +y from +z, and above the horizon; and its angular radius in
/// degrees.
inline constexpr double kSkySunAzimuth = 60.0, kSkySunElevation = 25.0, kSkySunRadius = 3.0;

/// An environment with `height` rows and twice as many columns. The sun has half of the light from above.
Environment makeSky(int height);

}  // namespace freevoxels
