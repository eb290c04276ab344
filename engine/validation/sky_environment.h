#pragma once
// A sky to light things with: brighter towards the horizon, a sun, and dark ground.

#include "engine/scene/environment.h"

namespace freevoxels {

/// Where the sun of makeSky is: degrees about +y from +z, and above the horizon; and half as wide as it is.
inline constexpr double kSkySunAzimuth = 60.0, kSkySunElevation = 25.0, kSkySunRadius = 3.0;

/// `height` rows, twice as many columns. Half of the light that comes from above is the sun's.
Environment makeSky(int height);

}  // namespace freevoxels
