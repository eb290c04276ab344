#pragma once
// Transfer functions that belong to no volume yet: of files (transfer_formats.h) and presets, whose points lie over x in 0..1.

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/volume/classification.h"

namespace freevoxels {

/// The values at which a function begins and ends.
struct ValueWindow {
  double low = 0.0, high = 1.0;  ///< low < high, also as floats

  bool operator==(const ValueWindow&) const = default;
};

struct TransferCurves {
  /// Which scalars are at x = 0 and 1.
  enum class Range {
    Values,  ///< `window`
    All,     ///< the least and the largest of the volume
    Usual    ///< usualRange() of the volume (scan.h)
  };
  struct OpacityPoint {
    double x, opacity;  ///< 0..1, the opacity for each unit distance
  };
  struct ColorPoint {
    double x;
    glm::dvec3 color;  ///< linear Rec.709, 0..1
  };
  std::vector<OpacityPoint> opacity;  ///< at least one, x ascending
  std::vector<ColorPoint> color;      ///< x ascending; none: white
  Range range = Range::All;
  ValueWindow window;                  ///< of Range::Values
  std::optional<double> unitDistance;  ///< world length that the opacity is of
  std::optional<double> unitShare;     ///< the same as a share of the longest side of the volume's box; without both a voxel
  std::string description;             ///< what it is for; may be empty
  std::vector<std::string> warnings;   ///< clauses about what of a file is not drawn: "its gradient opacity is not drawn"
};

/// What the user changes of a function.
struct TransferChange {
  std::optional<ValueWindow> window;  ///< replaces the range: x = 0 and 1 are its ends
  double opacity = 1.0;               ///< factor of the extinction, above 0: an opacity o becomes 1 - (1 - o)^factor
  bool inverted = false;              ///< the colour at x becomes that at 1 - x; opacities stay

  bool operator==(const TransferChange&) const = default;
};

/// The opacity of colour maps that have none, for each kMapUnitShare of the volume's box: a ramp.
inline constexpr double kMapOpacity = 0.3, kMapUnitShare = 1.0 / 128.0;
void addMapOpacity(TransferCurves& curves);

/// The scalars at x = 0 and 1 for a volume.
ValueWindow windowOf(const TransferCurves& curves, const Volume& volume);
/// The length in world units that the opacity is of.
double unitDistanceOf(const TransferCurves& curves, const Volume& volume);

/// The function of a volume.
TransferFunction fitted(const TransferCurves& curves, const Volume& volume, const TransferChange& change = {});
/// The same of a function that belongs to a volume already: a window is where its first and its last point go.
TransferFunction changed(TransferFunction function, const TransferChange& change);
/// The curves of a function over the range of its points.
TransferCurves curvesOf(const TransferFunction& function);

/// From the JSON of apps/manual/classification.md. `name` is what sentences call the text. Unknown keys, wrong types and points that do not
/// ascend fail with ErrorKind::Input and the name of the key.
TransferCurves parseTransferCurves(const std::string& name, const std::string& json);
/// Such JSON, a key on each line; opacities and colours are rounded to six digits.
std::string transferCurvesJson(const TransferCurves& curves);

}  // namespace freevoxels
