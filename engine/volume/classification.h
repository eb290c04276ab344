#pragma once
// Classification: from scalars to extinction and colour, either physical (density x scale, one albedo) or by
// a transfer function.

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/volume/volume.h"

namespace freevoxels {

/// Upper bound of opacity, so that extinction stays finite.
inline constexpr double kMaxOpacity = 1.0 - 1.0 / 4096.0;

/// Upper bound of extinction, so that products and sums stay finite in 32-bit floats.
inline constexpr double kMaxExtinction = 1e30;

/// A function that is piecewise linear in the scalar and constant beyond its first and last point.
/// apps/manual/classification.md has the JSON schema.
struct TransferFunction {
  struct OpacityPoint {
    float scalar;   ///< already mapped to the volume's scalars
    float opacity;  ///< 0..1 per `unitDistance`
    bool operator==(const OpacityPoint&) const = default;
  };
  struct ColorPoint {
    float scalar;
    glm::vec3 color;  ///< linear Rec.709
    bool operator==(const ColorPoint&) const = default;
  };
  std::vector<OpacityPoint> opacity;  ///< at least one, scalars ascending
  std::vector<ColorPoint> color;      ///< at least one, scalars ascending
  double unitDistance = 1.0;          ///< world length that `opacity` refers to
  bool operator==(const TransferFunction&) const = default;
};

/// Emission of black bodies by temperature (blackbody.h).
struct Emission {
  double strength = 1.0;  ///< luminance per world unit at kReferenceTemperature
  /// Kelvin = scale x value + offset.
  double temperatureScale = 1.0, temperatureOffset = 0.0;
  bool operator==(const Emission&) const = default;
};

/// What a transfer function is applied to. Post: scalars interpolated at the samples of a ray. Pre: voxels,
/// whose extinction and colour are then interpolated. Without a transfer function both are the same.
enum class ClassificationOrder : int { Post = 0, Pre = 1 };

struct Classification {
  std::optional<TransferFunction> transferFunction;  ///< when set, the two below are not used
  double densityScale = 1.0;                         ///< extinction per world unit at density 1
  glm::vec3 albedo{0.9f};  ///< linear Rec.709; the volume's albedo grid takes precedence where it is active
  std::optional<Emission> emission = std::nullopt;        ///< from the volume's temperatures, if it has any
  ClassificationOrder order = ClassificationOrder::Post;  ///< ignored for volumes with emission, which are Pre

  bool operator==(const Classification&) const = default;
  /// Whether samples of the volume are classified after interpolation (Post applies).
  bool isPost(const Volume& volume) const;
};

struct ClassifiedVoxel {
  double extinction = 0.0;  ///< sigma, per world unit
  glm::dvec3 color{0.0};
  glm::dvec3 emission{0.0};  ///< per world unit
};

/// Classifies a single scalar in double precision; VoxelClassifier classifies voxels. kInactiveVoxel has
/// extinction 0. A negative scalar is a density of 0, or data for a transfer function.
ClassifiedVoxel classify(const Classification& classification, float scalar);

/// The emitted light per world unit of a black body, linear Rec.709, at most kMaxExtinction; 0 for kInactiveVoxel and
/// below kColdestLight.
glm::dvec3 emittedLight(const Emission& emission, float temperature);
/// The same of a voxel of a volume with temperatures, or with TemperatureGrid::isRadiance: strength x value x colour.
glm::dvec3 emittedLight(const Emission& emission, const Volume& volume, glm::ivec3 voxel, float value);
/// The largest component of the light that a voxel of this value of the grid emits at most.
double brightestLight(const Emission& emission, const TemperatureGrid& grid, float value);

/// The largest component of the light that any voxel emits, or 0.
double brightestLight(const Classification& classification, const Volume& volume);
/// The albedo of a voxel, linear, in 0..1.
glm::vec3 albedoOf(const Classification& classification, const AlbedoGrid& grid, glm::ivec3 voxel);

/// One line of JSON that parses as the same function (transfer_curves.h).
std::string transferFunctionJson(const TransferFunction& function);

/// The density scale at which a cube that holds the volume of the active voxels at their mean density has
/// this optical depth. The default is kAutomaticOpticalDepth, for volumes with emission kShiningOpticalDepth,
/// so that flames remain visible.
inline constexpr double kAutomaticOpticalDepth = 6.0, kShiningOpticalDepth = 2.0;
double automaticDensityScale(const Volume& volume, double opticalDepth);
/// The optical depth of a voxel of a solid (Volume::isSolid) with density 1.
inline constexpr double kSolidOpticalDepth = 3.0;

/// The default albedo of volumes with emission.
inline constexpr float kSmokeAlbedo = 0.5f;

/// The default mapping of temperature grids to kelvin. A grid without values above kMinKelvinMaximum is not
/// in kelvin: its 0 becomes kEmberTemperature and its largest value kReferenceTemperature.
inline constexpr double kMinKelvinMaximum = 200.0, kEmberTemperature = 1000.0;
bool areKelvin(const TemperatureGrid& grid);
/// Whether temperatures that are not in kelvin are below 0 as well, as those of weather are, and not of a fire.
bool areBelowZero(const TemperatureGrid& grid);
double automaticTemperatureOffset(const TemperatureGrid& grid);
double automaticTemperatureScale(const TemperatureGrid& grid, double offset);

/// The default emission strength (that of `emission` is ignored): a cube that emits all the light of the
/// volume has luminance kAutomaticRadiance, or where the volume has light of its own (TemperatureGrid::isRadiance) radiance 1. The cube is
/// as large as that number of voxels of one temperature which has the same sum of light and the same sum of squares, and it is dimmed by
/// the mean extinction where the light is.
inline constexpr double kAutomaticRadiance = 2.0;
double automaticEmissionStrength(const Volume& volume, const Classification& classification,
                                 const Emission& emission);

}  // namespace freevoxels
