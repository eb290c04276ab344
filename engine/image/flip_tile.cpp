#include "engine/image/flip_tile.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace freevoxels {

namespace {

// Andersson et al. 2020: exponents and shares of the colour difference (section 4.1.3), exponent of the
// feature difference and width of the feature detectors in degrees (section 4.2).
constexpr float kColorExponent = 0.7f;    // q_c
constexpr float kSplitShare = 0.4f;       // p_c: where the differences are split, of the largest there is
constexpr float kSplitTarget = 0.95f;     // p_t: where the split ends up
constexpr float kFeatureExponent = 0.5f;  // q_f
constexpr double kFeatureWidth = 0.082;   // w

/// a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees (Eq. 4 and Table 1).
struct SensitivityTerm {
  double a, b;
};
constexpr SensitivityTerm kAchromatic{1.0, 0.0047};
constexpr SensitivityTerm kRedGreen{1.0, 0.0053};
constexpr SensitivityTerm kBlueYellow[] = {{34.1, 0.04}, {13.5, 0.025}};

double sigmaInDegrees(SensitivityTerm term) {
  return std::sqrt(term.b / 2.0) / std::numbers::pi;
}

double sum(const std::vector<double>& values) {
  double total = 0.0;
  for (const double value : values) total += value;
  return total;
}

Kernel scaled(const std::vector<double>& values, double scale) {
  Kernel kernel{int(values.size() / 2), {}};
  for (const double value : values) kernel.weights.push_back(float(value * scale));
  return kernel;
}

/// exp(-x^2 / (2 sigma^2)) for x = -radius..radius pixels, without values that are 0 in 32-bit floats.
std::vector<double> gaussianValues(double sigma, int radius) {
  radius = std::min(radius, int(std::ceil(6.5 * sigma)));
  std::vector<double> values;
  for (int x = -radius; x <= radius; ++x) values.push_back(std::exp(-0.5 * x * x / (sigma * sigma)));
  return values;
}

/// The weighted Gaussians, which share one square support, normalised to a sum of 1 together.
std::vector<FlipFilters::Product> sensitivityFilter(const std::vector<SensitivityTerm>& terms,
                                                    double pixelsPerDegree, int radius) {
  std::vector<std::vector<double>> gaussians;
  std::vector<double> volumes;
  for (const SensitivityTerm& term : terms) {
    gaussians.push_back(gaussianValues(sigmaInDegrees(term) * pixelsPerDegree, radius));
    const double area = sum(gaussians.back());
    volumes.push_back(term.a * std::sqrt(std::numbers::pi / term.b) * area * area);
  }
  std::vector<FlipFilters::Product> products;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const double area = sum(gaussians[i]), share = volumes[i] / sum(volumes);
    products.push_back({scaled(gaussians[i], 1.0 / area), scaled(gaussians[i], share / area)});
  }
  return products;
}

/// Scales the values so that positive weights sum to 1 and negative weights to -1.
Kernel balanced(const std::vector<double>& values) {
  double positive = 0.0, negative = 0.0;
  for (const double value : values) (value > 0.0 ? positive : negative) += value;
  std::vector<double> result;
  for (const double value : values) result.push_back(value > 0.0 ? value / positive : value / -negative);
  return scaled(result, 1.0);
}

/// Linear Rec.709 to CIE XYZ relative to its white, D65: (1, 1, 1) stays (1, 1, 1). From the primaries'
/// chromaticities in ITU-R BT.709.
glm::mat3 makeRgbToXyz() {
  const auto color = [](double x, double y) { return glm::dvec3(x / y, 1.0, (1.0 - x - y) / y); };
  const glm::dmat3 primaries(color(0.64, 0.33), color(0.30, 0.60), color(0.15, 0.06));
  const glm::dvec3 white = color(0.3127, 0.3290), scale = glm::inverse(primaries) * white;
  glm::dmat3 matrix;
  for (int c = 0; c < 3; ++c) matrix[c] = primaries[c] * scale[c] / white;
  return glm::mat3(matrix);
}

const glm::mat3 kRgbToXyz = makeRgbToXyz();
const glm::mat3 kXyzToRgb = glm::inverse(kRgbToXyz);

/// The linear space of section 4.1.1, after CIELAB.
glm::vec3 toYCxCz(glm::vec3 xyz) {
  return {116.0f * xyz.y - 16.0f, 500.0f * (xyz.x - xyz.y), 200.0f * (xyz.y - xyz.z)};
}

glm::vec3 fromYCxCz(glm::vec3 color) {
  const float y = (color.x + 16.0f) / 116.0f;
  return {y + color.y / 500.0f, y, y - color.z / 200.0f};
}

float labCurve(float t) {
  constexpr float kDelta = 6.0f / 29.0f;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
}

/// CIELAB, whose chroma is scaled by lightness for the Hunt effect (section 4.1.2).
glm::vec3 toHuntLab(glm::vec3 rgb) {
  const glm::vec3 xyz = kRgbToXyz * rgb;
  const float x = labCurve(xyz.x), y = labCurve(xyz.y), z = labCurve(xyz.z);
  const float lightness = 116.0f * y - 16.0f;
  return {lightness, 0.01f * lightness * 500.0f * (x - y), 0.01f * lightness * 200.0f * (y - z)};
}

/// The HyAB distance (Eq. 7).
float hyab(glm::vec3 a, glm::vec3 b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// The largest difference that a display can show: green to blue.
const float kMaxDifference = std::pow(hyab(toHuntLab({0.0f, 1.0f, 0.0f}), toHuntLab({0.0f, 0.0f, 1.0f})), kColorExponent);

/// 0..1: compressed, then split so that small differences get most of the range (section 4.1.3).
float colorDifference(glm::vec3 a, glm::vec3 b) {
  const float difference = std::pow(hyab(a, b), kColorExponent);
  const float split = kSplitShare * kMaxDifference;
  if (difference < split) return kSplitTarget / split * difference;
  return kSplitTarget + (difference - split) / (kMaxDifference - split) * (1.0f - kSplitTarget);
}

/// A tile after the model of the eye.
struct PerceivedTile {
  PerceivedTile(const DisplayedTile& tile, const FlipFilters& filters);

  glm::vec3 color(std::size_t i) const {
    return {channels[0].values[i], channels[1].values[i], channels[2].values[i]};
  }

  int width, height;
  Plane channels[3];  ///< Hunt-adjusted CIELAB after the filters of contrast sensitivity
  Plane edge, point;  ///< 0..1, magnitudes of features

 private:
  void filterColors(const DisplayedTile& tile, const FlipFilters& filters);
  void detectFeatures(const Plane& luminance, const FlipFilters& filters);
};

PerceivedTile::PerceivedTile(const DisplayedTile& tile, const FlipFilters& filters)
    : width(tile.channels[0].width - 2 * filters.margin()),
      height(tile.channels[0].height - 2 * filters.margin()),
      channels{{width, height}, {width, height}, {width, height}},
      edge(width, height),
      point(width, height) {
  filterColors(tile, filters);
  detectFeatures(tile.channels[0], filters);
}

void PerceivedTile::filterColors(const DisplayedTile& tile, const FlipFilters& filters) {
  Plane rows(width, tile.channels[0].height);
  for (std::size_t c = 0; c < 3; ++c)
    for (const FlipFilters::Product& product : filters.contrastSensitivity[c]) {
      filterRows(tile.channels[c], product.rows, rows);
      addFilteredColumns(rows, product.columns, channels[c]);
    }
  for (std::size_t i = 0; i < edge.values.size(); ++i) {
    const glm::vec3 lab = toHuntLab(glm::clamp(kXyzToRgb * fromYCxCz(color(i)), 0.0f, 1.0f));
    for (int c = 0; c < 3; ++c) channels[c].values[i] = lab[c];
  }
}

void PerceivedTile::detectFeatures(const Plane& luminance, const FlipFilters& filters) {
  Plane rows(width, luminance.height), alongX(width, height), alongY(width, height);
  const auto detect = [&](const Kernel& kernel, Plane& magnitude) {
    filterRows(luminance, kernel, rows);
    filterColumns(rows, filters.gaussian, alongX);
    filterRows(luminance, filters.gaussian, rows);
    filterColumns(rows, kernel, alongY);
    for (std::size_t i = 0; i < magnitude.values.size(); ++i) {
      const float x = alongX.values[i], y = alongY.values[i];
      // The filters have a sum of 0. Only the factor 116 of Y's range, 116 y - 16, therefore matters.
      magnitude.values[i] = std::sqrt(x * x + y * y) / 116.0f;
    }
  };
  detect(filters.edge, edge);
  detect(filters.point, point);
}

}  // namespace

FlipFilters::FlipFilters(double pixelsPerDegree) {
  const int sensitivityRadius = int(std::ceil(3.0 * sigmaInDegrees(kBlueYellow[0]) * pixelsPerDegree));
  contrastSensitivity[0] = sensitivityFilter({kAchromatic}, pixelsPerDegree, sensitivityRadius);
  contrastSensitivity[1] = sensitivityFilter({kRedGreen}, pixelsPerDegree, sensitivityRadius);
  contrastSensitivity[2] =
      sensitivityFilter({kBlueYellow[0], kBlueYellow[1]}, pixelsPerDegree, sensitivityRadius);

  const double sigma = 0.5 * kFeatureWidth * pixelsPerDegree;
  const int radius = int(std::ceil(3.0 * sigma));
  const std::vector<double> values = gaussianValues(sigma, radius);
  std::vector<double> first = values, second = values;
  for (int x = -radius; x <= radius; ++x) {
    first[std::size_t(x + radius)] *= -x;
    second[std::size_t(x + radius)] *= x * x / (sigma * sigma) - 1.0;
  }
  gaussian = scaled(values, 1.0 / sum(values));
  edge = balanced(first);
  point = balanced(second);
  margin_ = std::max(sensitivityRadius, radius);
}

void DisplayedTile::set(int x, int y, const float color[3]) {
  const glm::vec3 shown = glm::clamp(glm::vec3(color[0], color[1], color[2]), 0.0f, 1.0f);
  const glm::vec3 value = toYCxCz(kRgbToXyz * shown);
  for (int c = 0; c < 3; ++c) channels[c].row(y)[x] = value[c];
}

bool DisplayedTile::operator==(const DisplayedTile& other) const {
  return std::ranges::equal(channels, other.channels, {}, &Plane::values, &Plane::values);
}

Plane flipTile(const DisplayedTile& test, const DisplayedTile& reference, const FlipFilters& filters) {
  const int margin = filters.margin();
  Plane result(test.channels[0].width - 2 * margin, test.channels[0].height - 2 * margin);
  if (test == reference) return result;  // much of an image of a volume is background
  const PerceivedTile a(test, filters), b(reference, filters);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    const float color = colorDifference(a.color(i), b.color(i));
    const float strongest = std::max(std::abs(a.edge.values[i] - b.edge.values[i]),
                                     std::abs(a.point.values[i] - b.point.values[i]));
    const float feature = std::pow(strongest / std::numbers::sqrt2_v<float>, kFeatureExponent);
    result.values[i] = std::pow(color, 1.0f - feature);  // Eq. 15
  }
  return result;
}

}  // namespace freevoxels
