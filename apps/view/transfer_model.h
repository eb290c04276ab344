#pragma once
// A transfer function that the user edits: points over x in 0..1, as in its JSON
// (apps/manual/classification.md).

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/volume/transfer_curves.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Rounds to a multiple of a power of ten, without the rest that a product would have.
double roundedTo(double value, double step);

/// Least distance between the points of a list.
inline constexpr double kMinPointGap = 1e-3;

struct TransferModel {
  struct OpacityPoint {
    double x, alpha;
  };
  struct ColorPoint {
    double x;
    glm::dvec3 color;  ///< linear Rec.709
  };
  std::vector<OpacityPoint> opacity{{0.0, 0.0}, {1.0, 1.0}};  ///< at least one, x ascending
  std::vector<ColorPoint> color;                              ///< x ascending; none: white
  std::optional<glm::dvec2> range;  ///< scalars at x = 0 and 1; default: the volume's
  std::optional<double> unitDistance;

  /// Reads an option's text: a preset, a file name, or JSON. Fails as `freevoxels render` does.
  static TransferModel read(const std::string& text, const Volume& volume);
  /// One line of JSON; edited numbers have few digits.
  std::string json() const;

  double alphaAt(double x) const;
  glm::dvec3 colorAt(double x) const;

  /// All return the index of the point: a new one, or one that exists already.
  std::size_t addOpacity(double x, double alpha);
  /// Adds a point with the colour at its position.
  std::size_t addColor(double x);

  /// Moves a point between its neighbours; the first and the last point of the opacity keep their x.
  void moveOpacity(std::size_t point, double x, double alpha);
  void moveColor(std::size_t point, double x);

  /// Does nothing and returns false for the first and the last point.
  bool removeOpacity(std::size_t point);
  /// Does nothing and returns false for the only point.
  bool removeColor(std::size_t point);

  /// The values at x = 0 and 1 of a volume of which `all` are the least and the largest.
  ValueWindow window(ValueWindow all) const { return range ? ValueWindow{range->x, range->y} : all; }

  /// Replaces the curves; range and unit distance stay.
  void takeCurves(const TransferModel& other);
};

/// A window that is wider and higher by these. It stays wide enough to have an inside, and its middle among `all` values.
ValueWindow movedWindow(const ValueWindow& window, const ValueWindow& all, glm::dvec2 widthAndMiddle);

}  // namespace freevoxels
