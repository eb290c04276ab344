#include "engine/volume/transfer_interpolation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

using std::numbers::pi;

constexpr glm::dvec3 kWhitePoint(0.9505, 1.0, 1.089);  // of D65
constexpr double kPlaceOfJump = 1e-6;                   // between its two sides, of the whole range
constexpr double kTolerance = 1e-3;                     // of the values between points
constexpr int kFewestHalvings = 2, kMaxHalvings = 8;
constexpr double kMaxScalar = 1e30;

double linearOf(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

double srgbOf(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

glm::dvec3 linearOf(glm::dvec3 c) {
  return {linearOf(c.r), linearOf(c.g), linearOf(c.b)};
}

glm::dvec3 labOf(glm::dvec3 srgb) {
  const glm::dvec3 c = linearOf(srgb);
  const glm::dvec3 xyz = glm::dvec3(0.4124 * c.r + 0.3576 * c.g + 0.1805 * c.b, 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b,
                                    0.0193 * c.r + 0.1192 * c.g + 0.9505 * c.b) /
                         kWhitePoint;
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  return {116.0 * f(xyz.y) - 16.0, 500.0 * (f(xyz.x) - f(xyz.y)), 200.0 * (f(xyz.y) - f(xyz.z))};
}

/// Colours that no display has are darkened until their largest component is 1.
glm::dvec3 srgbOfLab(glm::dvec3 lab) {
  const double y = (lab.x + 16.0) / 116.0, x = lab.y / 500.0 + y, z = y - lab.z / 200.0;
  const auto g = [](double t) { return t * t * t > 0.008856 ? t * t * t : (t - 16.0 / 116.0) / 7.787; };
  const glm::dvec3 xyz = glm::dvec3(g(x), g(y), g(z)) * kWhitePoint;
  const glm::dvec3 c = glm::max(glm::dvec3(3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z, -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
                                           0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z),
                                glm::dvec3(0.0));
  const glm::dvec3 srgb(srgbOf(c.r), srgbOf(c.g), srgbOf(c.b));
  return srgb / std::max({1.0, srgb.r, srgb.g, srgb.b});
}

/// Hue, saturation and value, all 0..1.
glm::dvec3 hsvOf(glm::dvec3 c) {
  const double most = std::max({c.r, c.g, c.b}), least = std::min({c.r, c.g, c.b}), chroma = most - least;
  if (!(chroma > 0.0)) return {0.0, 0.0, most};
  double sixths = most == c.r ? (c.g - c.b) / chroma : most == c.g ? 2.0 + (c.b - c.r) / chroma : 4.0 + (c.r - c.g) / chroma;
  if (sixths < 0.0) sixths += 6.0;
  return {sixths / 6.0, chroma / most, most};
}

glm::dvec3 srgbOfHsv(glm::dvec3 hsv) {
  const auto component = [&](double shift) {
    const double sixths = std::fmod(shift + 6.0 * hsv.x, 6.0);
    return hsv.z - hsv.z * hsv.y * std::clamp(std::min(sixths, 4.0 - sixths), 0.0, 1.0);
  };
  return {component(5.0), component(3.0), component(1.0)};
}

/// CIELAB in polar coordinates: the magnitude, the angle from the grey axis, which is a saturation, and the hue.
struct Msh {
  double m, s, h;
};

Msh mshOf(glm::dvec3 lab) {
  const double m = glm::length(lab), s = m > 0.001 ? std::acos(std::clamp(lab.x / m, -1.0, 1.0)) : 0.0;
  return {m, s, s > 0.001 ? std::atan2(lab.z, lab.y) : 0.0};
}

glm::dvec3 labOf(const Msh& c) {
  return {c.m * std::cos(c.s), c.m * std::sin(c.s) * std::cos(c.h), c.m * std::sin(c.s) * std::sin(c.h)};
}

/// The hue that a grey of magnitude `m` gets on the way from a saturated colour.
double hueTowards(const Msh& saturated, double m) {
  if (saturated.m >= m - 0.1) return saturated.h;
  const double spin = saturated.s * std::sqrt(m * m - saturated.m * saturated.m) / (saturated.m * std::sin(saturated.s));
  return saturated.h > -0.3 * pi ? saturated.h + spin : saturated.h - spin;
}

glm::dvec3 divergingColor(glm::dvec3 firstColor, glm::dvec3 secondColor, double place) {
  constexpr double kGrey = 0.05, kFarHues = 0.33 * pi, kMinWhite = 88.0;
  Msh first = mshOf(labOf(firstColor)), second = mshOf(labOf(secondColor));
  double between = std::fmod(std::abs(first.h - second.h), 2.0 * pi);
  if (between > pi) between = 2.0 * pi - between;
  if (first.s > kGrey && second.s > kGrey && between > kFarHues) {  // white is in the middle
    const Msh white{std::max({first.m, second.m, kMinWhite}), 0.0, 0.0};
    (place < 0.5 ? second : first) = white;
    place = place < 0.5 ? 2.0 * place : 2.0 * place - 1.0;
  }
  if (first.s < kGrey && second.s > kGrey) first.h = hueTowards(second, first.m);
  if (second.s < kGrey && first.s > kGrey) second.h = hueTowards(first, second.m);
  return srgbOfLab(labOf(Msh{std::lerp(first.m, second.m, place), std::lerp(first.s, second.s, place), std::lerp(first.h, second.h, place)}));
}

glm::dvec3 hsvColor(glm::dvec3 firstColor, glm::dvec3 secondColor, double place, bool wraps) {
  glm::dvec3 first = hsvOf(firstColor), second = hsvOf(secondColor);
  if (wraps && std::abs(first.x - second.x) > 0.5) (first.x > second.x ? first : second).x -= 1.0;
  glm::dvec3 hsv = glm::mix(first, second, place);
  if (hsv.x < 0.0) hsv.x += 1.0;
  return srgbOfHsv(hsv);
}

/// What is between two points of a file.
template <typename Value>
struct Way {
  double first, last;                                ///< x of its ends
  std::function<Value(double)> at;                   ///< the value at a place 0..1
  std::optional<double> step;                        ///< the place of a step, between which and its ends values do not change
  double bend = 1.0;                                 ///< a place at which the way may have a bend
  int fewest = 0;                                    ///< halvings at least
};

double largestOf(double v) {
  return std::abs(v);
}
double largestOf(glm::dvec3 v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

template <typename Value>
using Placed = std::vector<std::pair<double, Value>>;

/// Adds points behind `low` up to `high`, so that lines between them follow the way.
template <typename Value>
void addPlaces(Placed<Value>& points, const Way<Value>& way, double low, double high, int halvings) {
  const Value first = way.at(low), last = way.at(high);
  bool isLine = halvings >= way.fewest;
  for (const double part : {0.25, 0.5, 0.75})
    isLine = isLine && largestOf(way.at(std::lerp(low, high, part)) - (first * (1.0 - part) + last * part)) <= kTolerance;
  if (isLine || halvings == kMaxHalvings) {
    points.emplace_back(std::lerp(way.first, way.last, high), last);
    return;
  }
  const double middle = 0.5 * (low + high);
  addPlaces(points, way, low, middle, halvings + 1);
  addPlaces(points, way, middle, high, halvings + 1);
}

template <typename Value>
void addWay(Placed<Value>& points, const Way<Value>& way) {
  if (!way.step) {
    addPlaces(points, way, 0.0, way.bend, 0);
    if (way.bend < 1.0) addPlaces(points, way, way.bend, 1.0, 0);
    return;
  }
  const double x = std::lerp(way.first, way.last, *way.step);
  points.emplace_back(x, way.at(0.0));
  points.emplace_back(x, way.at(1.0));
  points.emplace_back(way.last, way.at(1.0));
}

/// Makes x ascend, with a small distance between the two sides of a jump.
template <typename Value>
void separate(Placed<Value>& points) {
  Placed<Value> apart;
  for (auto& [x, value] : points) {
    x = std::clamp(x, 0.0, 1.0);
    const bool isSame = !apart.empty() && x < apart.back().first + kPlaceOfJump;
    const bool isJump = apart.size() > 1 && apart.back().first < apart[apart.size() - 2].first + 1.5 * kPlaceOfJump;
    if (!isSame)
      apart.emplace_back(x, value);
    else if (largestOf(value - apart.back().second) <= 0.0)
      continue;
    else if (isJump)  // the last value is the other side
      apart.back().second = value;
    else
      apart.emplace_back(apart.back().first + kPlaceOfJump, value);
  }
  if (apart.back().first > 1.0) {  // a jump at the end
    apart.back().first = 1.0;
    apart[apart.size() - 2].first = 1.0 - kPlaceOfJump;
  }
  points = std::move(apart);
}

/// Leaves out points that lie on the line between those that stay.
template <typename Value>
void simplify(Placed<Value>& points) {
  constexpr std::size_t kMostSkipped = 64;
  Placed<Value> kept{points.front()};
  std::size_t first = 0;
  const auto isLine = [&](std::size_t last) {
    for (std::size_t i = first + 1; i < last; ++i) {
      const double part = (points[i].first - points[first].first) / (points[last].first - points[first].first);
      if (largestOf(points[i].second - (points[first].second * (1.0 - part) + points[last].second * part)) > 0.5 * kTolerance) return false;
    }
    return true;
  };
  while (first + 1 < points.size()) {
    std::size_t last = first + 1;
    while (last + 1 < points.size() && last - first < kMostSkipped && isLine(last + 1)) ++last;
    kept.push_back(points[last]);
    first = last;
  }
  points = std::move(kept);
}

/// The points of the curve; `wayOf(a, b)` is that between two points of the file, `valueOf(a)` that of one.
template <typename Value, typename Point, typename ValueOf, typename WayOf>
Placed<Value> placesOf(const std::vector<Point>& points, const ValueWindow& window, const ValueOf& valueOf, const WayOf& wayOf) {
  const auto xOf = [&](const Point& point) { return (point.scalar - window.low) / (window.high - window.low); };
  Placed<Value> places{{xOf(points.front()), valueOf(points.front())}};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    Way<Value> way = wayOf(points[i], points[i + 1]);
    way.first = xOf(points[i]);
    way.last = xOf(points[i + 1]);
    if (way.last - way.first > kPlaceOfJump)
      addWay(places, way);
    else
      places.emplace_back(way.last, valueOf(points[i + 1]));
  }
  separate(places);
  simplify(places);
  return places;
}

template <typename Point>
bool isStep(const Point& point) {
  return point.sharpness > 0.99;
}

/// The place at which the way behind a point may have a bend; its end where there is none.
template <typename Point>
double bendOf(const Point& point) {
  return point.midpoint == 0.5 && point.sharpness == 0.0 ? 1.0 : point.midpoint;
}

Placed<double> opacityPlaces(const std::vector<FileOpacity>& points, const ValueWindow& window) {
  const auto wayOf = [](const FileOpacity& a, const FileOpacity& b) {
    Way<double> way;
    way.at = [a, b](double place) { return std::lerp(a.opacity, b.opacity, shapedPlace(place, a.midpoint, a.sharpness)); };
    way.bend = bendOf(a);
    if (isStep(a)) way.step = a.midpoint;
    return way;
  };
  return placesOf<double>(points, window, [](const FileOpacity& point) { return point.opacity; }, wayOf);
}

Placed<glm::dvec3> colorPlaces(const std::vector<FileColor>& points, const ValueWindow& window, ColorSpace space) {
  const auto wayOf = [space](const FileColor& a, const FileColor& b) {
    Way<glm::dvec3> way;
    way.at = [a, b, space](double place) {
      return linearOf(interpolatedColor(space, a.color, b.color, shapedPlace(place, a.midpoint, a.sharpness)));
    };
    way.bend = bendOf(a);
    if (isStep(a)) way.step = a.midpoint;
    if (space == ColorSpace::Step) {
      way.step = 0.0;
      way.at = [a, b](double place) { return linearOf(place == 0.0 ? a.color : b.color); };
    }
    way.fewest = space == ColorSpace::Rgb ? 0 : kFewestHalvings;
    return way;
  };
  return placesOf<glm::dvec3>(points, window, [](const FileColor& point) { return linearOf(point.color); }, wayOf);
}

/// Sorts the points and brings their numbers into their ranges.
template <typename Point, typename Limit>
void tidy(const std::string& name, std::vector<Point>& points, const Limit& limit) {
  if (points.size() > kMaxFilePoints)
    fail(ErrorKind::Input, "transfer function '{}' has {} points, which are more than {}; thin it out", name, points.size(),
         kMaxFilePoints);
  for (Point& point : points) {
    const bool isFinite = std::abs(point.scalar) <= kMaxScalar && std::isfinite(point.midpoint) && std::isfinite(point.sharpness);
    if (!isFinite || !limit(point))
      fail(ErrorKind::Input, "transfer function '{}' has a point of which a number is missing or not finite; correct that", name);
    point.midpoint = std::clamp(point.midpoint, 1e-5, 1.0 - 1e-5);
    point.sharpness = std::clamp(point.sharpness, 0.0, 1.0);
  }
  std::ranges::stable_sort(points, {}, &Point::scalar);
}

/// From the first to the last point.
ValueWindow windowOfPoints(const FileFunction& function) {
  ValueWindow window{kMaxScalar, -kMaxScalar};
  const auto include = [&](const auto& points) {
    if (points.empty()) return;
    window = {std::min(window.low, points.front().scalar), std::max(window.high, points.back().scalar)};
  };
  include(function.opacity);
  include(function.color);
  if (!(float(window.low) < float(window.high))) window.high = window.low + std::max(1.0, 1e-3 * std::abs(window.low));
  return window;
}

}  // namespace

double shapedPlace(double place, double midpoint, double sharpness) {
  double s = place < midpoint ? 0.5 * place / midpoint : 0.5 + 0.5 * (place - midpoint) / (1.0 - midpoint);
  if (sharpness > 0.99) return s < 0.5 ? 0.0 : 1.0;
  if (sharpness < 0.01) return s;
  const double exponent = 1.0 + 10.0 * sharpness;
  s = s < 0.5 ? 0.5 * std::pow(2.0 * s, exponent) : 1.0 - 0.5 * std::pow(2.0 - 2.0 * s, exponent);
  // A cubic of Hermite with the same slope at both ends.
  const double ramp = s * s * (3.0 - 2.0 * s), bump = s * (s * (2.0 * s - 3.0) + 1.0);
  return ramp + (1.0 - sharpness) * bump;
}

glm::dvec3 interpolatedColor(ColorSpace space, glm::dvec3 first, glm::dvec3 second, double place) {
  switch (space) {
    case ColorSpace::Hsv:
    case ColorSpace::HsvWrapped:
      return hsvColor(first, second, place, space == ColorSpace::HsvWrapped);
    case ColorSpace::Lab:
      return srgbOfLab(glm::mix(labOf(first), labOf(second), place));
    case ColorSpace::Diverging:
      return divergingColor(first, second, place);
    case ColorSpace::Step:
      return second;
    case ColorSpace::Rgb:
      break;
  }
  return glm::mix(first, second, place);
}

TransferCurves curvesOf(const std::string& name, FileFunction function) {
  tidy(name, function.opacity, [](FileOpacity& point) {
    const bool isFinite = std::isfinite(point.opacity);
    point.opacity = std::clamp(point.opacity, 0.0, 1.0);
    return isFinite;
  });
  tidy(name, function.color, [](FileColor& point) {
    const bool isFinite = std::isfinite(point.color.r + point.color.g + point.color.b);
    point.color = glm::clamp(point.color, 0.0, 1.0);
    return isFinite;
  });
  if (function.opacity.empty() && function.color.empty())
    fail(ErrorKind::Input, "transfer function '{}' has neither points of opacity nor of colour; give it some", name);
  TransferCurves curves{.range = function.range, .window = function.window.value_or(windowOfPoints(function))};
  curves.unitDistance = function.unitDistance;
  curves.unitShare = function.unitShare;
  curves.warnings = std::move(function.warnings);
  if (function.opacity.empty())
    addMapOpacity(curves);
  else
    for (const auto& [x, opacity] : opacityPlaces(function.opacity, curves.window)) curves.opacity.push_back({x, opacity});
  if (!function.color.empty())
    for (const auto& [x, color] : colorPlaces(function.color, curves.window, function.space)) curves.color.push_back({x, glm::clamp(color, 0.0, 1.0)});
  return curves;
}

}  // namespace freevoxels
