#pragma once
// The light of something hot: Planck's law seen by the CIE 1931 standard observer (2 degrees), in linear
// Rec.709.

#include <glm/glm.hpp>

namespace freevoxels {

/// Kelvin. What is colder sends out no light that an eye would see; what is hotter looks as if it were not.
inline constexpr double kColdestLight = 500.0, kHottestLight = 40000.0;

/// Kelvin, of a wood fire's hottest flames: luminances are relative to this temperature's.
inline constexpr double kReferenceTemperature = 2000.0;

/// CIE XYZ of a black body from kColdestLight to kHottestLight, Y = 1 at kReferenceTemperature.
glm::dvec3 blackbodyXyz(double kelvin);

/// The same in linear Rec.709; colours outside of its gamut are cut to it at their luminance. Interpolated,
/// to 1e-4 of the luminance; 0 of what is colder than kColdestLight.
glm::dvec3 blackbodyColor(double kelvin);

}  // namespace freevoxels
