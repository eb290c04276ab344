#pragma once
// Scalar -> (colour, extinction). Two ways: physical (density x scale, one albedo) and transfer function.

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/volume/volume.h"

namespace freevoxels {

/// Opacities are clamped to this, so that extinction stays finite.
inline constexpr double kMaximumOpacity = 1.0 - 1.0 / 4096.0;

/// Extinctions are clamped to this, so that their products and sums stay finite in 32-bit floats.
inline constexpr double kMaximumExtinction = 1e30;

/// Piecewise linear in the scalar, constant beyond the first and last point. Schema: README.md.
struct TransferFunction {
  struct OpacityPoint {
    float scalar;   ///< already mapped to the volume's scalars
    float opacity;  ///< 0..1 per `unitDistance`
  };
  struct ColorPoint {
    float scalar;
    glm::vec3 color;  ///< linear Rec.709
  };
  std::vector<OpacityPoint> opacity;  ///< at least one, scalars ascending
  std::vector<ColorPoint> color;      ///< at least one, scalars ascending
  double unitDistance = 1.0;          ///< world length that `opacity` refers to
};

/// What voxels send out by their temperature, as black bodies do (blackbody.h).
struct Emission {
  double strength = 1.0;  ///< luminance per world unit of what has kReferenceTemperature
  /// Kelvin = scale x value + offset.
  double temperatureScale = 1.0, temperatureOffset = 0.0;
};

/// What a transfer function is applied to. Post: scalars interpolated at samples, as far as they are gathered one by one;
/// pre: voxels, whose extinction and colour are interpolated. Without a transfer function the two are the same.
enum class ClassificationOrder : int { Post = 0, Pre = 1 };

class EmissionLight;

struct Classification {
  std::optional<TransferFunction> transferFunction;  ///< when set, the two below are not used
  double densityScale = 1.0;                         ///< extinction per world unit at density 1
  glm::vec3 albedo{0.9f};  ///< linear Rec.709; the volume's grid of them has precedence where it is active
  std::optional<Emission> emission = std::nullopt;  ///< of the volume's temperatures, if it has any
  std::shared_ptr<const EmissionLight> emissionLight = nullptr;  ///< lights the medium with the emission; null: it lights nothing
  ClassificationOrder order = ClassificationOrder::Post;  ///< Pre of volumes that shine, whatever this is

  /// Whether samples of the volume are classified after interpolation.
  bool isPost(const Volume& volume) const;
};

struct ClassifiedVoxel {
  double extinction = 0.0;  ///< sigma, per world unit
  glm::dvec3 color{0.0};
  glm::dvec3 emission{0.0};  ///< per world unit
};

/// Of a single scalar, in double precision: voxel_classifier.h has the voxels'. kInactiveVoxel gives extinction 0. A negative
/// scalar counts as 0 in the physical way, as data with a transfer function.
ClassifiedVoxel classify(const Classification& classification, float scalar);

/// Per world unit, linear Rec.709; 0 of kInactiveVoxel and of what is colder than kColdestLight, at most
/// kMaximumExtinction.
glm::dvec3 emittedLight(const Emission& emission, float temperature);

/// The largest component of the light that any voxel sends out; 0 where none does.
double brightestLight(const Classification& classification, const Volume& volume);
/// Linear, in 0..1.
glm::vec3 albedoOf(const Classification& classification, const AlbedoGrid& grid, glm::ivec3 voxel);

/// Reads the JSON of README.md, section "Transfer functions". `range` defaults to the volume's minimum and
/// maximum, `unit_distance` to its voxel size. Unknown keys, wrong types, points that do not ascend:
/// ExitCode::Input, by name.
TransferFunction readTransferFunction(const std::filesystem::path& file, const Volume& volume);
/// The same of the JSON itself.
TransferFunction parseTransferFunction(const std::string& json, const Volume& volume);
/// JSON that is read as the same function, in one line.
std::string transferFunctionJson(const TransferFunction& function);

/// The density scale at which a cube that holds the volume of the active voxels at their mean density has this optical depth.
/// Where none is given it is kAutomaticOpticalDepth, of volumes that shine kShiningOpticalDepth, so that flames are seen.
inline constexpr double kAutomaticOpticalDepth = 6.0, kShiningOpticalDepth = 2.0;
double automaticDensityScale(const Volume& volume, double opticalDepth);
/// Of a level set: the optical depth of a voxel inside.
inline constexpr double kLevelSetOpticalDepth = 3.0;

/// Of the smoke of a fire, where no albedo is given.
inline constexpr float kSmokeAlbedo = 0.5f;

/// How temperatures become kelvin where that is not given. Grids of which no value is above
/// kLeastKelvinMaximum are in no kelvin: 0 is kEmberTemperature and the largest kReferenceTemperature.
inline constexpr double kLeastKelvinMaximum = 200.0, kEmberTemperature = 1000.0;
double automaticTemperatureOffset(const TemperatureGrid& grid);
double automaticTemperatureScale(const TemperatureGrid& grid, double offset);

/// The strength used when none is given (`emission` has another one): a cube that sends out all the light has
/// luminance kAutomaticRadiance. It is as large as so many voxels of one temperature as would have this light
/// and this sum of its squares, and dims it by the mean extinction where the light is.
inline constexpr double kAutomaticRadiance = 2.0;
double automaticEmissionStrength(const Volume& volume, const Classification& classification,
                                 const Emission& emission);

}  // namespace freevoxels
