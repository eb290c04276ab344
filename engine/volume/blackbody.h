#pragma once
// The light of hot bodies: Planck's law seen by the CIE 1931 standard observer (2 degrees), in linear
// Rec.709.

#include <glm/glm.hpp>

namespace freevoxels {

/// In kelvin. Below kColdestLight no visible light is emitted; above kHottestLight the light is that of
/// kHottestLight.
inline constexpr double kColdestLight = 500.0, kHottestLight = 40000.0;

/// The temperature of the hottest flames of a wood fire, in kelvin. Luminances are relative to that of this
/// temperature.
inline constexpr double kReferenceTemperature = 2000.0;

/// CIE XYZ of a black body of kColdestLight to kHottestLight, with Y = 1 at kReferenceTemperature.
glm::dvec3 blackbodyXyz(double kelvin);

/// The light of a black body in linear Rec.709, interpolated to 1e-4 of its luminance, and 0 below
/// kColdestLight. Colours outside of the gamut are clipped to it at the same luminance.
glm::dvec3 blackbodyColor(double kelvin);

}  // namespace freevoxels
