#pragma once
// Reference images: a converged ray march on the CPU in double precision, without splats and attenuation
// tables. See engine/docs/validation.md.
//
// Either voxels are classified and the field is interpolated trilinearly, or scalars are interpolated and
// every point is classified (reference_field.h). Light is emitted and absorbed along N x N rays a pixel
// (ray_march.h); N is doubled until the image no longer changes.

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>

#include "engine/core/stages.h"
#include "engine/image/image.h"
#include "engine/scene/camera.h"
#include "engine/scene/holdout.h"
#include "engine/scene/lighting.h"
#include "engine/scene/render_settings.h"
#include "engine/volume/classification.h"
#include "engine/volume/scattering_medium.h"
#include "engine/volume/volume.h"

namespace freevoxels {

struct OracleSettings {
  glm::ivec2 size{1024, 1024};
  bool depth = false;       ///< whether to compute Image::depth
  double step = 0.2;        ///< largest distance between quadrature points, in voxels
  double tolerance = 1e-3;  ///< largest change of a pixel's premultiplied RGBA by the last doubling
  int maximumSamples = 32;  ///< most rays along an edge of a pixel: a power of two, at least 4
  std::optional<Lighting> lighting = std::nullopt;  ///< if empty, every voxel sends out its colour
  IntensityProjection projection = IntensityProjection::None;  ///< of values, without lighting
  std::shared_ptr<const Holdout> holdout = nullptr;  ///< of the image's size: where the rays of its pixels end; null if there is none
};

struct Oracle {
  Image image;
  int samples = 0;             ///< most rays along an edge of a pixel that any pixel needed
  double largestChange = 0.0;  ///< largest change of any pixel's RGBA by its own last doubling
  std::uint64_t rays = 0;
  bool converged = true;  ///< false if `maximumSamples` was reached
};

/// A pixel's N starts at 2, or, if a pixel is larger than a voxel, at the number of voxels across it, up to
/// 16. It is doubled at least once, and again while a doubling changes the pixel or one of its eight
/// neighbours by the tolerance or more. Rays pass through the centres of N x N equal parts. Alpha is the mean
/// of 1 - exp(-tau), exact on each ray. Light of lights is scattered with shadow rays, other
/// light is found on cells (light_march.h). Depth is defined as in
/// apps/manual/images.md, over all rays of the pixel, and is not part of the convergence test. Nothing behind
/// the eye is drawn. The result does not depend on the number of threads.
Oracle renderOracle(const Volume& volume, const Classification& classification, const Camera& camera,
                    const OracleSettings& settings, const Progress& progress = {});

/// The same of one or several volumes, which attenuate and shadow each other. Those of several are marched in steps of half of `step`
/// (merged_march.h).
Oracle renderOracle(std::span<const PlacedMedium> volumes, const Camera& camera, const OracleSettings& settings,
                    const Progress& progress = {});

/// Bytes of memory that the oracle needs for every pixel and for every voxel, including its scalar, of a
/// volume that is full and many bricks long in all three directions. The other constants are needed in
/// addition for every voxel: with ambient light (three times that with an environment or a tint), with
/// temperatures, and with a grid of albedos.
inline constexpr std::uint64_t kOracleBytesPerVoxel = 28, kOracleBytesPerPixel = 96;
inline constexpr std::uint64_t kOracleAmbientBytesPerVoxel = 40, kOracleLightBytesPerVoxel = 28,
                               kOracleAlbedoBytesPerVoxel = 12;

}  // namespace freevoxels
