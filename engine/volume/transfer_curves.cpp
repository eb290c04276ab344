#include "engine/volume/transfer_curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/volume/scan.h"

namespace freevoxels {

namespace {

double longestSide(const Volume& volume) {
  double longest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    longest = std::max(longest, double(volume.dimensions[axis]) * glm::length(glm::dvec3(volume.indexToWorld[axis])));
  return longest;
}

std::vector<TransferCurves::ColorPoint> inverted(std::vector<TransferCurves::ColorPoint> points) {
  std::ranges::reverse(points);
  for (TransferCurves::ColorPoint& point : points) point.x = 1.0 - point.x;
  return points;
}

TransferFunction placed(const TransferCurves& curves, const ValueWindow& window, bool isInverted) {
  const auto toScalar = [&](double x) { return float(window.low + x * (window.high - window.low)); };
  TransferFunction function;
  for (const auto& [x, opacity] : curves.opacity) function.opacity.push_back({toScalar(x), float(opacity)});
  for (const auto& [x, color] : isInverted ? inverted(curves.color) : curves.color)
    function.color.push_back({toScalar(x), glm::vec3(color)});
  if (function.color.empty()) function.color.push_back({toScalar(0.0), glm::vec3(1.0f)});
  return function;
}

}  // namespace

void addMapOpacity(TransferCurves& curves) {
  curves.opacity = {{0.0, 0.0}, {1.0, kMapOpacity}};
  curves.unitDistance.reset();
  curves.unitShare = kMapUnitShare;
}

ValueWindow windowOf(const TransferCurves& curves, const Volume& volume) {
  if (curves.range == TransferCurves::Range::Values) return curves.window;
  return curves.range == TransferCurves::Range::Usual ? usualRange(volume) : ValueWindow{volume.minimum, volume.maximum};
}

double unitDistanceOf(const TransferCurves& curves, const Volume& volume) {
  if (curves.unitDistance) return *curves.unitDistance;
  const double side = curves.unitShare ? *curves.unitShare * longestSide(volume) : 0.0;
  return side > 0.0 ? side : volume.voxelSize();
}

TransferFunction fitted(const TransferCurves& curves, const Volume& volume, const TransferChange& change) {
  TransferFunction function = placed(curves, change.window ? *change.window : windowOf(curves, volume), change.inverted);
  function.unitDistance = unitDistanceOf(curves, volume) / change.opacity;
  return function;
}

TransferFunction changed(TransferFunction function, const TransferChange& change) {
  const double unitDistance = function.unitDistance / change.opacity;
  if (change.window || change.inverted) {
    const TransferCurves curves = curvesOf(function);
    TransferFunction other = placed(curves, change.window.value_or(curves.window), change.inverted);
    function.color = std::move(other.color);
    if (change.window) function.opacity = std::move(other.opacity);  // which otherwise stay to the last bit
  }
  function.unitDistance = unitDistance;
  return function;
}

TransferCurves curvesOf(const TransferFunction& function) {
  TransferCurves curves{.range = TransferCurves::Range::Values};
  const double low = std::min(function.opacity.front().scalar, function.color.front().scalar);
  const double high = std::max(function.opacity.back().scalar, function.color.back().scalar);
  const double width = high > low ? high - low : 1.0;
  curves.window = {low, low + width};
  curves.unitDistance = function.unitDistance;
  for (const auto& [scalar, opacity] : function.opacity) curves.opacity.push_back({(scalar - low) / width, opacity});
  for (const auto& [scalar, color] : function.color) curves.color.push_back({(scalar - low) / width, glm::dvec3(color)});
  return curves;
}

}  // namespace freevoxels
