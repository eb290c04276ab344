#pragma once
// The splat footprint: the line integral of a voxel's reconstruction kernel, as a function of the ray's
// distance r to the voxel's centre in index space:  f(r) = 5 / (pi R²) * (1 - r²/R²)⁴  for r < R.
//
// It is the projection of the radially symmetric kernel k(rho) ~ (1 - rho²/R²)^(7/2). R puts the first zero
// of the footprint's spectrum on the lattice's first harmonic (J5(2 pi R) = 0), so the footprints of a
// constant volume add up to a constant to 0.29 % for the worst, axis-aligned, view; a Gaussian of standard
// deviation 0.5 reaches 2.9 % there and is wider. The standard deviation, R/sqrt(12) = 0.403 voxels, is that
// of trilinear interpolation (0.408).

#include <numbers>

namespace freevoxels {

inline constexpr double kFootprintRadius = 1.3960250075605876;
inline constexpr double kFootprintPeak = 5.0 / (std::numbers::pi * kFootprintRadius * kFootprintRadius);

}  // namespace freevoxels
