#pragma once
// How other programs interpolate between the points of their transfer functions, as points between which ours are linear: in display
// values (sRGB), HSV, CIELAB or along diverging maps, and with the midpoints and sharpnesses of VTK.

#include <string>
#include <vector>

#include "engine/volume/transfer_curves.h"

namespace freevoxels {

enum class ColorSpace { Rgb, Hsv, HsvWrapped, Lab, Diverging, Step };

/// The place between two points, 0..1, at which interpolation is for a place 0..1 along the scalar: VTK's curve through `midpoint`, which
/// `sharpness` brings from a line (0) to a step (1).
double shapedPlace(double place, double midpoint, double sharpness);

/// The colour at a place 0..1 between two, all in display values 0..1 (sRGB). Lab is CIELAB of D65; Diverging is that of Moreland 2009,
/// "Diverging color maps for scientific visualization"; the hue of Hsv goes through the hues between, of HsvWrapped the shorter way; Step
/// has the second colour everywhere.
glm::dvec3 interpolatedColor(ColorSpace space, glm::dvec3 first, glm::dvec3 second, double place);

/// A point of a file. The midpoint and the sharpness are those of the way to the next point.
struct FileOpacity {
  double scalar, opacity;
  double midpoint = 0.5, sharpness = 0.0;
};
struct FileColor {
  double scalar;
  glm::dvec3 color;  ///< display values
  double midpoint = 0.5, sharpness = 0.0;
};

/// A function as a file has it.
struct FileFunction {
  std::vector<FileOpacity> opacity;  ///< none: that of a colour map (addMapOpacity)
  std::vector<FileColor> color;      ///< none: white
  ColorSpace space = ColorSpace::Rgb;
  std::optional<ValueWindow> window;  ///< where x = 0 and 1 are; else the first and the last point
  /// What the window is of: the values that the points have, all values of the volume, or the usual ones.
  TransferCurves::Range range = TransferCurves::Range::Values;
  std::optional<double> unitDistance, unitShare;
  std::vector<std::string> warnings;
};

/// The most points that a file may have.
inline constexpr std::size_t kMaxFilePoints = 1 << 16;

/// Our curves of it, which differ by at most 1/500 of the full range of opacities and linear colours. Points are sorted by their scalars; of
/// several with the same scalar the first and the last are the two sides of a jump. Values beyond 0..1 are limited. Fails with
/// ErrorKind::Input and the name for numbers that are not finite, no points at all, and too many.
TransferCurves curvesOf(const std::string& name, FileFunction function);

}  // namespace freevoxels
