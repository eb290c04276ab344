// Emission and absorption after Max 1995, "Optical models for direct volume rendering":
//   C = integral of T(t) (sigma(t) c(t) + j(t)) ds,   T = exp(-integral of sigma ds up to t).
//
// Within a cell the trilinear field f(x, y, z) is linear in each coordinate. Along the segment from a to b it
// is a cubic of s in 0..1, and the values of f at the corners of the segment's bounding box are its polar
// form:   f(s) = sum over i, j, k in {a, b} of f(i_x, j_y, k_z) s^m (1 - s)^(3 - m),   m = how many are b.
// All terms are positive, so nothing cancels however large the extinction is.

#include "engine/reference/ray_march.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace freevoxels {

namespace {

constexpr double kNegligibleTransmittance = 1e-7;

/// Gauss-Legendre on 0..1, three points and two.
constexpr std::array<double, 3> kNodes = {0.1127016653792583, 0.5, 0.8872983346207417};
constexpr std::array<double, 2> kTwoNodes = {0.2113248654051871, 0.7886751345948129};
constexpr std::array<double, 3> kWeights = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
/// Largest distance between neighbouring nodes as a fraction of the interval.
constexpr double kNodeDistance = 0.3872983346207417;

/// Largest optical depth of a quadrature interval. At 1/2 the three points have an error of 1e-8.
constexpr double kMaxIntervalDepth = 0.5;
/// Largest number of intervals in a cell. Reached only if its optical depth is above 2000, so that the ray
/// ends at once.
constexpr double kMaxIntervals = 4096.0;

/// Calls visit(cube, t0, t1) for the unit cubes from `first` to `last` that the ray passes between `enter`
/// and `leave`, in order, until it returns false. The parts add up to the whole, whatever the rounding:
/// planes beyond the range are not crossed.
template <typename Visit>
void walkCubes(glm::dvec3 origin, glm::dvec3 direction, glm::ivec3 first, glm::ivec3 last, double enter,
               double leave, Visit&& visit) {
  const glm::dvec3 start = glm::floor(origin + enter * direction);
  glm::ivec3 cube(glm::clamp(start, glm::dvec3(first), glm::dvec3(last)));
  while (enter < leave) {
    double next = leave;
    int crossed = -1;
    for (int axis = 0; axis < 3; ++axis) {
      const bool up = direction[axis] > 0.0;
      if (direction[axis] == 0.0 || cube[axis] == (up ? last[axis] : first[axis])) continue;
      const double t = (cube[axis] + (up ? 1.0 : 0.0) - origin[axis]) / direction[axis];
      if (t >= next) continue;
      next = t;
      crossed = axis;
    }
    if (next > enter && !visit(cube, enter, next)) return;
    if (crossed < 0) return;
    enter = std::max(enter, next);
    cube[crossed] += direction[crossed] > 0.0 ? 1 : -1;
  }
}

/// A cubic polynomial: the sum of term[m] s^m (1 - s)^(3 - m).
struct Cubic {
  std::array<glm::dvec4, 4> term{};

  glm::dvec4 at(double s) const {
    const double r = 1.0 - s;
    return r * r * r * term[0] + r * r * s * term[1] + r * s * s * term[2] + s * s * s * term[3];
  }
};

/// The field's extinction (a) and extinction times colour (rgb) from a to b, local coordinates of a cell in
/// 0..1. `corner` is the cell's first.
Cubic cubicAlong(const glm::vec4* corner, glm::dvec3 a, glm::dvec3 b) {
  constexpr int n = ReferenceField::kBrickCorners;
  Cubic cubic;
  for (int i = 0; i < 2; ++i) {
    std::array<glm::dvec4, 4> edges;
    for (int edge = 0; edge < 4; ++edge) {
      const glm::vec4* const start = corner + n * ((edge & 1) + n * (edge >> 1));
      edges[std::size_t(edge)] = glm::mix(glm::dvec4(start[0]), glm::dvec4(start[1]), i == 0 ? a.x : b.x);
    }
    for (int j = 0; j < 2; ++j) {
      const double y = j == 0 ? a.y : b.y;
      const glm::dvec4 near = glm::mix(edges[0], edges[1], y), far = glm::mix(edges[2], edges[3], y);
      cubic.term[std::size_t(i + j)] += glm::mix(near, far, a.z);
      cubic.term[std::size_t(i + j + 1)] += glm::mix(near, far, b.z);
    }
  }
  return cubic;
}

/// The steps along a segment of a cell, from a to b in local coordinates 0..1, over each of which the scalar
/// is nearly linear, so that the transfer function's integral gives its means.
struct ClassifiedSteps {
  static constexpr double kStepsPerVoxel = 16.0;

  const TransferIntegral& integral;
  Cubic cubic;  ///< scalar times coverage (r), coverage (a)
  int count;
  double scalar;  ///< scalar at the end of the previous step

  ClassifiedSteps(const TransferIntegral& of, const glm::vec4* corner, glm::dvec3 a, glm::dvec3 b, double atLeast)
      : integral(of),
        cubic(cubicAlong(corner, a, b)),
        count(int(std::ceil(std::max(atLeast, kStepsPerVoxel * glm::length(b - a))))),
        scalar(scalarAt(0.0)) {
    count = std::max(count, 1);
  }
  /// At an end of the segment that is not covered, a point one step inside is covered.
  double scalarAt(double s) const {
    const glm::dvec4 value = cubic.at(std::clamp(s, 1e-9, 1.0 - 1e-9));
    return value.a > 0.0 ? value.r / value.a : 0.0;
  }
  /// The means of extinction times colour and of extinction over step i. Must be called for one step after
  /// the other.
  glm::dvec4 mean(int i) {
    const double next = scalarAt(double(i + 1) / count);
    const glm::dvec4 result = cubic.at((i + 0.5) / count).a * integral.mean(scalar, next);
    scalar = next;
    return result;
  }
};

/// The field at local coordinates 0..1 of a cell; `corner` is the cell's first corner.
double extinctionAt(const glm::vec4* corner, glm::dvec3 local) {
  constexpr int n = ReferenceField::kBrickCorners;
  std::array<double, 4> edges;
  for (int edge = 0; edge < 4; ++edge) {
    const glm::vec4* const start = corner + n * ((edge & 1) + n * (edge >> 1));
    edges[std::size_t(edge)] = glm::mix(double(start[0].a), double(start[1].a), local.x);
  }
  return glm::mix(glm::mix(edges[0], edges[1], local.y), glm::mix(edges[2], edges[3], local.y), local.z);
}

/// The integral of a cubic's extinction from 0: sum of term[m] s^m (1 - s)^(4 - m).
struct Depth {
  std::array<double, 5> term{};

  Depth(const Cubic& cubic, double length) {
    constexpr std::array<double, 4> kCubicBinomials = {1, 3, 3, 1};
    constexpr std::array<double, 5> kQuarticBinomials = {1, 4, 6, 4, 1};
    double sum = 0.0;
    for (std::size_t m = 0; m < 4; ++m) {
      sum += cubic.term[m].a / kCubicBinomials[m] * (length / 4.0);
      term[m + 1] = kQuarticBinomials[m + 1] * sum;
    }
  }
  double at(double s) const {
    const double r = 1.0 - s;
    return s * (r * r * r * term[1] + r * r * s * term[2] + r * s * s * term[3] + s * s * s * term[4]);
  }
};

/// Calls visit(corner, emission, cell, t0, t1) for the cells with extinction or emission that the ray passes up to `leave`, in order, until
/// it returns false. `corner` is the cell's first corner in its brick, `emission` that in the brick of emission, or null.
template <typename Visit>
void walkField(const ReferenceField& field, const MarchedRay& ray, double leave, Visit&& visit) {
  double enter = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = ray.origin[axis], direction = ray.direction[axis];
    const double low = -1.0, high = field.dimensions()[axis];
    if (direction == 0.0) {
      if (origin <= low || origin >= high) return;
      continue;
    }
    const double t0 = (low - origin) / direction, t1 = (high - origin) / direction;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  constexpr double edge = ReferenceField::kBrickCells;
  const auto crossBrick = [&](glm::ivec3 position, double t0, double t1) {
    static const ReferenceField::Brick kEmpty{};
    const ReferenceField::Brick* const emission = field.emission(position);
    const ReferenceField::Brick* const brick =
        field.brick(position) || !emission ? field.brick(position) : &kEmpty;
    if (!brick) return true;
    constexpr int n = ReferenceField::kBrickCorners;
    const glm::ivec3 first = position * ReferenceField::kBrickCells - 1;
    bool goOn = true;
    const auto crossCell = [&](glm::ivec3 cell, double from, double to) {
      const glm::ivec3 local = cell - first;
      if (!emission && !field.isFilled(*brick, local)) return true;
      const int corner = local.x + n * (local.y + n * local.z);
      goOn = visit(brick->data() + corner, emission ? emission->data() + corner : nullptr, cell, from, to);
      return goOn;
    };
    walkCubes(ray.origin, ray.direction, first, first + ReferenceField::kBrickCells - 1, t0, t1, crossCell);
    return goOn;
  };
  walkCubes((ray.origin + 1.0) / edge, ray.direction / edge, glm::ivec3(0), field.brickCount() - 1, enter,
            leave, crossBrick);
}

/// Local coordinates in a cell, 0..1.
glm::dvec3 localAt(const MarchedRay& ray, glm::ivec3 cell, double t) {
  return glm::clamp(ray.origin + t * ray.direction - glm::dvec3(cell), 0.0, 1.0);
}

class March {
 public:
  March(const ReferenceField& field, const MarchedRay& ray, double step, const LightMarch* light)
      : field_(field),
        ray_(ray),
        light_(light),
        toEye_(-ray.worldDirection),
        intervals_(glm::length(ray.direction) * kNodeDistance / step) {}

  RaySum run();

 private:
  bool crossCell(const glm::vec4* corner, const glm::vec4* emission, glm::ivec3 cell, double enter, double leave);
  bool crossClassified(const glm::vec4* corner, glm::ivec3 cell, double enter, double leave);
  double absorb(double thickness);
  glm::dvec3 lightOver(double transmittanceBefore) const;
  void addEvenly(double thickness);
  void addInterval(const Cubic& cubic, const Cubic* emission, const Depth& depth, double begin, double end,
                   double enter, double length);

  const ReferenceField& field_;
  const MarchedRay& ray_;
  const LightMarch* const light_;
  const glm::dvec3 toEye_;
  const double intervals_;  ///< number per unit of t
  double transmittance_ = 1.0;
  RaySum sum_;
};

RaySum March::run() {
  walkField(field_, ray_, ray_.end,
            [this](const glm::vec4* corner, const glm::vec4* emission, glm::ivec3 cell, double enter, double leave) {
              return crossCell(corner, emission, cell, enter, leave);
            });
  return sum_;
}

bool March::crossCell(const glm::vec4* corner, const glm::vec4* emission, glm::ivec3 cell, double enter, double leave) {
  if (field_.integral() != nullptr) return crossClassified(corner, cell, enter, leave);
  const Cubic cubic = cubicAlong(corner, localAt(ray_, cell, enter), localAt(ray_, cell, leave));
  std::optional<Cubic> emitted;
  if (emission) emitted = cubicAlong(emission, localAt(ray_, cell, enter), localAt(ray_, cell, leave));
  const double length = (leave - enter) * ray_.worldLength;
  const Depth depth(cubic, length);
  const double total = depth.at(1.0);
  if (!(total > 0.0) && !emitted) return true;
  if (field_.evenColor() && !ray_.distance && !light_ && !emitted) {
    addEvenly(total);
    return transmittance_ >= kNegligibleTransmittance;
  }
  const double wanted = std::max(total / kMaxIntervalDepth, (leave - enter) * intervals_);
  const int count = std::max(int(std::ceil(std::min(wanted, kMaxIntervals))), 1);
  for (int i = 0; i < count && transmittance_ >= kNegligibleTransmittance; ++i)
    addInterval(cubic, emitted ? &*emitted : nullptr, depth, double(i) / count, double(i + 1) / count, enter,
                leave - enter);
  return transmittance_ >= kNegligibleTransmittance;
}

bool March::crossClassified(const glm::vec4* corner, glm::ivec3 cell, double enter, double leave) {
  ClassifiedSteps steps(*field_.integral(), corner, localAt(ray_, cell, enter), localAt(ray_, cell, leave),
                        (leave - enter) * intervals_);
  const double length = (leave - enter) * ray_.worldLength / steps.count;
  for (int i = 0; i < steps.count && transmittance_ >= kNegligibleTransmittance; ++i) {
    const glm::dvec4 medium = steps.mean(i);
    if (!(medium.a > 0.0)) continue;
    const double t = enter + (i + 0.5) / steps.count * (leave - enter);
    const double before = transmittance_, energy = absorb(medium.a * length);
    glm::dvec3 color = glm::dvec3(medium) / medium.a;
    if (light_) color *= light_->scattered(ray_.origin + t * ray_.direction, toEye_);
    sum_.color += lightOver(before) * color;
    sum_.distance += energy * t;
  }
  return transmittance_ >= kNegligibleTransmittance;
}

/// Returns the light that an optical depth absorbs, which equals the light that it emits with colour 1.
double March::absorb(double thickness) {
  const double energy = transmittance_ * -std::expm1(-thickness);
  sum_.opacity += energy;
  transmittance_ -= energy;
  return energy;
}

/// The light of colour 1 from what was absorbed since the transmittance was `before`: with lights, some of what is scattered goes on.
glm::dvec3 March::lightOver(double before) const {
  if (!light_ || light_->deltaScale() == glm::dvec3(1.0)) return glm::dvec3(before - transmittance_);
  const glm::dvec3 n = light_->deltaScale();
  return (glm::pow(glm::dvec3(before), n) - glm::pow(glm::dvec3(transmittance_), n)) / n;
}

/// A uniform colour needs no quadrature.
void March::addEvenly(double thickness) {
  const double energy = absorb(thickness);
  sum_.color += energy * *field_.evenColor();
}

/// The light of an interval: its opacity times its mean colour, weighted by e; and its emission, which where
/// there is no opacity is multiplied by its length.
void March::addInterval(const Cubic& cubic, const Cubic* emission, const Depth& depth, double begin, double end,
                        double enter, double length) {
  glm::dvec4 mean(0.0);
  double distance = 0.0;
  const double before = depth.at(begin);
  double first = 0.0;  // weights are relative to the first node's, so that the largest optical depths do not underflow
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    const double s = begin + kNodes[i] * (end - begin);
    const double tau = depth.at(s);
    if (i == 0) first = tau;
    const double seen = i == 0 ? 1.0 : std::exp(first - tau);
    glm::dvec4 emitted = kWeights[i] * seen * cubic.at(s);
    const double t = enter + s * length;
    if (light_) emitted *= glm::dvec4(light_->scattered(ray_.origin + t * ray_.direction, toEye_), 1.0);
    if (emission) emitted += kWeights[i] * seen * emission->at(s);
    mean += emitted;
    distance += emitted.a * t;
  }
  if (!(mean.a > 0.0)) {
    sum_.color += transmittance_ * (end - begin) * length * ray_.worldLength * glm::dvec3(mean);
    return;
  }
  const double seenBefore = transmittance_, energy = absorb(depth.at(end) - before);
  sum_.color += lightOver(seenBefore) / mean.a * glm::dvec3(mean);
  sum_.distance += energy / mean.a * distance;
}

}  // namespace

RaySum marchRay(const ReferenceField& field, const MarchedRay& ray, double step, const LightMarch* light) {
  return March(field, ray, step, light).run();
}

RaySum projectRay(const ReferenceField& field, const MarchedRay& ray, const Classification& classification,
                  IntensityProjection projection) {
  constexpr double kMinCoverage = 0.5;
  double largest = -std::numeric_limits<double>::infinity(), largestAt = 0.0, sum = 0.0, coverage = 0.0, distance = 0.0;
  walkField(field, ray, ray.end, [&](const glm::vec4* corner, const glm::vec4*, glm::ivec3 cell, double enter, double leave) {
    const ClassifiedSteps steps(*field.integral(), corner, localAt(ray, cell, enter), localAt(ray, cell, leave), 1.0);
    const double part = (leave - enter) / steps.count;
    for (int i = 0; i < steps.count; ++i) {
      const glm::dvec4 value = steps.cubic.at((i + 0.5) / steps.count);
      const double scalar = value.r / value.a, t = enter + (i + 0.5) * part;
      if (value.a >= kMinCoverage && scalar > largest) {
        largest = scalar;
        largestAt = t;
      }
      sum += part * value.r;
      coverage += part * value.a;
      distance += part * value.a * t;
    }
    return true;
  });
  const bool isMaximum = projection == IntensityProjection::Maximum;
  if (isMaximum ? !std::isfinite(largest) : coverage == 0.0) return {};
  const ClassifiedVoxel shown = classify(classification, float(isMaximum ? largest : sum / coverage));
  const double opacity = -std::expm1(-shown.extinction * classification.transferFunction->unitDistance);
  return {.color = opacity * shown.color, .opacity = opacity, .distance = opacity * (isMaximum ? largestAt : distance / coverage)};
}

double marchDepth(const ReferenceField& field, const MarchedRay& ray, double end) {
  const double most = -std::log(kNegligibleTransmittance);
  double depth = 0.0;
  walkField(field, ray, end,
            [&](const glm::vec4* corner, const glm::vec4*, glm::ivec3 cell, double enter, double leave) {
              // Two Gauss points are exact for a cubic.
              const glm::dvec3 a = localAt(ray, cell, enter), b = localAt(ray, cell, leave);
              double sum = 0.0;
              if (field.integral() != nullptr) {
                ClassifiedSteps steps(*field.integral(), corner, a, b, 1.0);
                for (int i = 0; i < steps.count; ++i) sum += steps.mean(i).a;
                depth += sum / steps.count * (leave - enter) * ray.worldLength;
                return depth < most;
              }
              for (const double s : kTwoNodes) sum += extinctionAt(corner, glm::mix(a, b, s));
              depth += 0.5 * sum * (leave - enter) * ray.worldLength;
              return depth < most;
            });
  return depth;
}

}  // namespace freevoxels
