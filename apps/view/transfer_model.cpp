#include "apps/view/transfer_model.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

/// A hand is not more exact, and the command line stays short.
double rounded(double value) {
  constexpr double kSteps = 1e5;
  return std::round(std::clamp(value, 0.0, 1.0) * kSteps) / kSteps;
}

/// The last point that is not behind x; 0 where all are.
template <typename Points>
std::size_t before(const Points& points, double x) {
  const auto above = std::ranges::upper_bound(points, x, {}, [](const auto& point) { return point.x; });
  return above == points.begin() ? 0 : std::size_t(above - points.begin()) - 1;
}

/// `valueOf(point)`, linear between the points and constant beyond.
template <typename Points, typename ValueOf>
auto interpolated(const Points& points, double x, const ValueOf& valueOf) {
  const std::size_t low = before(points, x), high = std::min(low + 1, points.size() - 1);
  if (high == low || x <= points[low].x) return valueOf(points[low]);
  const double weight = (x - points[low].x) / (points[high].x - points[low].x);
  return valueOf(points[low]) * (1.0 - weight) + valueOf(points[high]) * weight;
}

/// x for a point, as near to that as its neighbours let it.
template <typename Points>
double placed(const Points& points, std::size_t point, double x) {
  const double low = point == 0 ? 0.0 : rounded(points[point - 1].x + kMinPointGap);
  const double high = point + 1 == points.size() ? 1.0 : rounded(points[point + 1].x - kMinPointGap);
  return low <= high ? std::clamp(rounded(x), low, high) : points[point].x;
}

/// The point that is so near to x that there is no room for another.
template <typename Points>
std::optional<std::size_t> near(const Points& points, double x) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::abs(points[i].x - x) < kMinPointGap) return i;
  return std::nullopt;
}

template <typename Points>
std::size_t insert(Points& points, const typename Points::value_type& point) {
  const auto above = std::ranges::upper_bound(points, point.x, {}, [](const auto& p) { return p.x; });
  const auto place = std::size_t(above - points.begin());
  points.insert(above, point);
  return place;
}

}  // namespace

double roundedTo(double value, double step) {
  const double steps = std::round(value / step);
  return step < 1.0 ? steps / std::round(1.0 / step) : steps * std::round(step);
}

TransferModel TransferModel::read(const std::string& text, const Volume& volume) {
  const TransferCurves curves = readTransferCurves(text);
  TransferModel model;
  model.opacity.clear();
  for (const auto& [x, opacity] : curves.opacity) model.opacity.push_back({x, opacity});
  for (const auto& [x, color] : curves.color) model.color.push_back({x, color});
  if (curves.range != TransferCurves::Range::All) {
    const ValueWindow values = windowOf(curves, volume);
    model.range = glm::dvec2(values.low, values.high);
  }
  if (curves.unitDistance || curves.unitShare) model.unitDistance = unitDistanceOf(curves, volume);
  return model;
}

std::string TransferModel::json() const {
  nlohmann::ordered_json root;
  if (range) root["range"] = {range->x, range->y};
  for (const OpacityPoint& point : opacity) root["opacity"].push_back({point.x, point.alpha});
  for (const ColorPoint& point : color)
    root["color"].push_back({point.x, point.color.r, point.color.g, point.color.b});
  if (unitDistance) root["unit_distance"] = *unitDistance;
  return root.dump();
}

double TransferModel::alphaAt(double x) const {
  return interpolated(opacity, x, [](const OpacityPoint& point) { return point.alpha; });
}

glm::dvec3 TransferModel::colorAt(double x) const {
  if (color.empty()) return glm::dvec3(1.0);
  return interpolated(color, x, [](const ColorPoint& point) { return point.color; });
}

std::size_t TransferModel::addOpacity(double x, double alpha) {
  x = rounded(x);
  if (const std::optional<std::size_t> there = near(opacity, x)) return *there;
  return insert(opacity, {x, rounded(alpha)});
}

std::size_t TransferModel::addColor(double x) {
  x = rounded(x);
  if (const std::optional<std::size_t> there = near(color, x)) return *there;
  return insert(color, {x, colorAt(x)});
}

void TransferModel::moveOpacity(std::size_t point, double x, double alpha) {
  const bool isEnd = point == 0 || point + 1 == opacity.size();
  if (!isEnd) opacity[point].x = placed(opacity, point, x);
  opacity[point].alpha = rounded(alpha);
}

void TransferModel::moveColor(std::size_t point, double x) {
  color[point].x = placed(color, point, x);
}

bool TransferModel::removeOpacity(std::size_t point) {
  if (point == 0 || point + 1 >= opacity.size()) return false;
  opacity.erase(opacity.begin() + std::ptrdiff_t(point));
  return true;
}

bool TransferModel::removeColor(std::size_t point) {
  if (color.size() < 2) return false;
  color.erase(color.begin() + std::ptrdiff_t(point));
  return true;
}

void TransferModel::takeCurves(const TransferModel& other) {
  opacity = other.opacity;
  color = other.color;
}

ValueWindow movedWindow(const ValueWindow& window, const ValueWindow& all, glm::dvec2 widthAndMiddle) {
  const double widest = 2.0 * (all.high - all.low), narrowest = 5e-4 * widest;
  const double width = std::clamp(window.high - window.low + widthAndMiddle.x, narrowest, widest);
  const double middle = std::clamp(0.5 * (window.low + window.high) + widthAndMiddle.y, all.low, all.high);
  const double step = std::pow(10.0, std::floor(std::log10(width)) - 4.0);
  return {roundedTo(middle - 0.5 * width, step), roundedTo(middle + 0.5 * width, step)};
}

}  // namespace freevoxels
