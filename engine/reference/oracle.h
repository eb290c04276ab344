#pragma once
// The picture as it should be: a converged ray march, on the CPU in double precision, that knows nothing of
// splats or attenuation tables. engine/docs/validation.md.
//
// Voxels are classified and the field interpolated trilinearly, or scalars are interpolated and points classified (reference_field.h), light emitted and
// absorbed along N x N rays a pixel (ray_march.h), N doubled until the picture no longer changes.

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "engine/core/stages.h"
#include "engine/image/image.h"
#include "engine/scene/camera.h"
#include "engine/scene/lighting.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

struct OracleSettings {
  glm::ivec2 size{1024, 1024};
  bool depth = false;       ///< also make Image::depth
  double step = 0.2;        ///< largest distance between quadrature points, in voxels
  double tolerance = 1e-3;  ///< how much doubling may still change any of a pixel's premultiplied RGBA
  int maximumSamples = 32;  ///< most rays along an edge of a pixel: a power of two, at least 4
  std::optional<Lighting> lighting = std::nullopt;  ///< none: every voxel sends out its colour
  int ambientRays = 128;                            ///< that light_march.h sends out from a point
};

struct Oracle {
  Image image;
  int samples = 0;             ///< most rays along an edge of a pixel that any pixel needed
  double largestChange = 0.0;  ///< of any pixel's RGBA by its own last doubling
  std::uint64_t rays = 0;
  bool converged = true;  ///< false where `maximumSamples` ended it
};

/// A pixel's N starts at 2, or where a pixel is larger than a voxel at as many voxels as there are across it,
/// 16 at most. It is doubled at least once, and as long as that changes the pixel or one of its eight
/// neighbours by the tolerance. Rays are regular, at the centres of N x N parts. Alpha is the mean of
/// 1 - exp(-tau), exact on each ray; lights are scattered once, with shadow rays of their own; depth is as in
/// apps/manual/images.md, over all of the pixel's rays, and takes no part in the test. Nothing behind the eye is drawn.
/// All cores; the same picture whatever their number.
Oracle renderOracle(const Volume& volume, const Classification& classification, const Camera& camera,
                    const OracleSettings& settings, const Progress& progress = {});

/// Memory that the oracle needs in bytes: for every pixel, and for every voxel, scalar included, of a volume
/// that is full and many bricks long in all three directions.
/// A voxel takes the more again where there is ambient light (three times that with an environment or a tint),
/// where there are temperatures, and where there is a grid of albedos.
inline constexpr std::uint64_t kOracleBytesPerVoxel = 28, kOracleBytesPerPixel = 96;
inline constexpr std::uint64_t kOracleAmbientBytesPerVoxel = 40, kOracleLightBytesPerVoxel = 28,
                               kOracleAlbedoBytesPerVoxel = 12;

}  // namespace freevoxels
