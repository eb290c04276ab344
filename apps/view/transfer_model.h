#pragma once
// A transfer function as a hand edits it: points over x in 0..1, as its JSON has them (apps/manual/classification.md).

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/volume/volume.h"

namespace freevoxels {

/// Points of one list are at least so far apart, wherever they are moved.
inline constexpr double kLeastPointGap = 1e-3;

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

  /// Of an option's text: the name of a file, or the JSON itself. Fails as `freevoxels render` does.
  static TransferModel read(const std::string& text, const Volume& volume);
  /// On one line; numbers that were edited have few digits.
  std::string json() const;

  double alphaAt(double x) const;
  glm::dvec3 colorAt(double x) const;

  /// All return the index of the point that is meant: a new one, or the one that was there already.
  std::size_t addOpacity(double x, double alpha);
  /// With the colour that is there.
  std::size_t addColor(double x);

  /// Between its neighbours; the first and the last point of the opacity keep their x.
  void moveOpacity(std::size_t point, double x, double alpha);
  void moveColor(std::size_t point, double x);

  /// False, and nothing, of the first and the last.
  bool removeOpacity(std::size_t point);
  /// False, and nothing, of the only one.
  bool removeColor(std::size_t point);

  /// Other curves over the same range and unit distance.
  void takeCurves(const TransferModel& other);
};

}  // namespace freevoxels
