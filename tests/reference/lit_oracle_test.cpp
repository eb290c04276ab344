// The lit oracle against closed forms and against a march in tiny steps.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "engine/reference/oracle.h"
#include "engine/reference/ray_march.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/validation/sky_environment.h"
#include "engine/volume/procedural.h"

namespace freevoxels {
namespace {

constexpr int kCubeEdge = 8;
constexpr double kDepth = 2.0, kPhaseG = 0.3, kAlbedo = 0.5;

Volume box() {
  return makeVolume(glm::ivec3(kCubeEdge), cubeTransform(glm::ivec3(kCubeEdge)), [](int, int, int) { return 1.0; });
}

/// The middle pixel of the box seen along -z.
glm::dvec3 middleColor(const Lighting& lighting, double depth) {
  const Camera camera{.position = {0, 0, 3}, .orthographic = true, .orthographicHeight = 0.01};
  const OracleSettings settings{.size = {1, 1}, .lighting = lighting};
  const Classification classification{.densityScale = depth, .albedo = glm::vec3(float(kAlbedo))};
  return glm::dvec3(renderOracle(box(), classification, camera, settings).image.pixels[0]);
}
double middle(const Lighting& lighting, double depth) {
  return middleColor(lighting, depth).r;
}

TEST(LitOracle, AHomogeneousBoxScattersWhatTheClosedFormsSay) {
  const auto from = [](glm::dvec3 direction) {
    return middle({.lights = {{.place = direction}}, .phaseG = kPhaseG}, kDepth);
  };
  const auto scattered = [](double cosine) {
    return kAlbedo * kDefaultIrradiance * phaseFunction(kPhaseG, cosine);
  };
  EXPECT_NEAR(from({0, 0, 2}) / (scattered(-1.0) * (1.0 - std::exp(-2.0 * kDepth)) / 2.0), 1.0, 1e-5);
  EXPECT_NEAR(from({0, 0, -1}) / (scattered(1.0) * kDepth * std::exp(-kDepth)), 1.0, 1e-5);
  // From the side it is less deep where the field falls to 0, half a voxel beyond the first and the last
  // face.
  double sum = 0.0, tau = 0.0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double z = (kCubeEdge + 1.0) * (i + 0.5) / kSteps;
    const double part = std::min({z, kCubeEdge + 1.0 - z, 1.0});
    const double thickness = kDepth / kCubeEdge * part * (kCubeEdge + 1.0) / kSteps;
    sum += std::exp(-tau - part * kDepth / 2.0) * thickness;
    tau += thickness;
  }
  EXPECT_NEAR(from({1, 0, 0}) / (scattered(0.0) * sum), 1.0, 1e-3);
}

/// Every colour has its own extinction on the way of the light alone.
TEST(LitOracle, ATintIsOfTheExtinctionTowardsTheLight) {
  const glm::dvec3 tint(0.5, 1.0, 2.0);
  const double white = kAlbedo * kDefaultIrradiance / (4.0 * std::numbers::pi);
  const auto from = [&](glm::dvec3 direction) {
    return middleColor({.lights = {{.place = direction}}, .tint = tint}, kDepth);
  };
  const glm::dvec3 inFront = from({0, 0, 1}), behind = from({0, 0, -1});
  for (int c = 0; c < 3; ++c) {
    const double there = (1.0 - std::exp(-(1.0 + tint[c]) * kDepth)) / (1.0 + tint[c]);
    const double less = 1.0 - tint[c];
    const double through = less == 0.0 ? kDepth : (1.0 - std::exp(-less * kDepth)) / less;
    EXPECT_NEAR(inFront[c] / (white * there), 1.0, 1e-5);
    EXPECT_NEAR(behind[c] / (white * std::exp(-tint[c] * kDepth) * through), 1.0, 1e-5);
  }
  const glm::dvec3 around = middleColor({.ambient = glm::dvec3(1.0), .tint = tint}, kDepth);
  EXPECT_DOUBLE_EQ(around.g, middle({.ambient = glm::dvec3(1.0)}, kDepth));
  EXPECT_GT(around.r, around.g);
  EXPECT_GT(around.g, around.b);
}

TEST(LitOracle, AmbientLightOfAThinBoxIsTheAlbedoTimesItsRadiance) {
  const double thin = 1e-4;
  EXPECT_NEAR(middle({.ambient = glm::dvec3(3.0)}, thin) / (3.0 * kAlbedo * thin), 1.0, 1e-3);
}

TEST(LitOracle, AnEnvironmentOfAThinBoxIsTheAlbedoTimesItsMeanRadiance) {
  const auto sky = std::make_shared<Environment>(makeSky(64));
  double mean = 0.1;
  for (int row = 0; row < environmentRows(*sky); ++row)
    for (const EnvironmentPart& part : environmentRow(*sky, row))
      mean += part.solidAngle / (4.0 * std::numbers::pi) * part.radiance.r;
  const double thin = 1e-4;
  EXPECT_NEAR(middle({.ambient = glm::dvec3(0.1), .environment = sky}, thin) / (mean * kAlbedo * thin), 1.0,
              1e-3);
}

TEST(LitOracle, AConstantEnvironmentIsAmbientLight) {
  const auto constant = std::make_shared<Environment>(
      Environment{.size = {2, 1}, .radiance = {glm::vec3(1.0f), glm::vec3(1.0f)}, .intensity = 3.0});
  EXPECT_NEAR(middle({.environment = constant}, kDepth) / middle({.ambient = glm::dvec3(3.0)}, kDepth), 1.0,
              5e-3);
}

/// A phase function only changes where light goes, and here it comes from everywhere.
TEST(LitOracle, APhaseFunctionDoesNotChangeAmbientLightOfAThinBox) {
  const double thin = 1e-4;
  EXPECT_NEAR(middle({.ambient = glm::dvec3(3.0), .phaseG = kPhaseG}, thin) / (3.0 * kAlbedo * thin), 1.0, 1e-2);
}

TEST(LitOracle, APointFarAwayIsADirection) {
  const glm::dvec3 direction(0.3, 0.8, 0.5);
  const Light far{
      .place = 1e4 * direction, .atInfinity = false, .intensity = 5.0 * 1e8 * glm::dot(direction, direction)};
  EXPECT_NEAR(middle({.lights = {far}}, kDepth) /
                  middle({.lights = {{.place = direction, .intensity = 5.0}}}, kDepth),
              1.0, 1e-3);
}

/// Both rays in midpoints of tiny steps, with an own interpolation.
TEST(LitOracle, MatchesTinySteps) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform;
  const glm::ivec3 n(5, 4, 6);
  const Volume volume = makeVolume(n, shearedTransform(n), [&](int, int, int) { return uniform(random); });
  const Classification classification{.densityScale = 6.0, .albedo = glm::vec3(0.7f)};
  const glm::dvec3 light(3.0, 1.5, 4.0);
  const auto sigma = [&](glm::dvec3 p) {
    const glm::ivec3 low(glm::floor(p));
    double sum = 0.0;
    for (int c = 0; c < 8; ++c) {
      const glm::ivec3 v = low + glm::ivec3(c & 1, c >> 1 & 1, c >> 2);
      if (glm::any(glm::lessThan(v, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(v, n))) continue;
      const glm::dvec3 share = 1.0 - glm::abs(p - glm::dvec3(v));
      sum += share.x * share.y * share.z * 6.0 * double(volume.scalar(v.x, v.y, v.z));
    }
    return sum;
  };
  const glm::dmat3 toWorld(volume.indexToWorld);
  const glm::dvec3 worldLight(volume.indexToWorld * glm::dvec4(light, 1.0));
  const glm::dvec3 origin(-2.0, 1.0, 2.0), direction = glm::normalize(glm::dvec3(1.0, 0.2, 0.1));
  const double worldLength = glm::length(toWorld * direction);
  double expected = 0.0, tau = 0.0;
  constexpr int kSteps = 2000, kLightSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double step = 10.0 / kSteps;
    const glm::dvec3 p = origin + (i + 0.5) * step * direction;
    const double thickness = sigma(p) * step * worldLength;
    if (thickness == 0.0) continue;
    const glm::dvec3 way = light - p;
    double toLight = 0.0;
    for (int j = 0; j < kLightSteps; ++j)
      toLight += sigma(p + (j + 0.5) / kLightSteps * way) * glm::length(toWorld * way) / kLightSteps;
    const double distance2 = glm::dot(toWorld * way, toWorld * way);
    const double cosine = glm::dot(-glm::normalize(toWorld * way), -glm::normalize(toWorld * direction));
    expected += std::exp(-tau - 0.5 * thickness) * thickness * 0.7 * 2.0 / distance2 * std::exp(-toLight) *
                phaseFunction(kPhaseG, cosine);
    tau += thickness;
  }
  const ReferenceField field(volume, classification);
  const LightMarch march(field, volume, classification,
                         {.lights = {{.place = worldLight, .atInfinity = false, .intensity = 2.0}}, .phaseG = kPhaseG});
  const RaySum sum = marchRay(field,
                              {.origin = origin,
                               .direction = direction,
                               .worldLength = worldLength,
                               .worldDirection = glm::normalize(toWorld * direction)},
                              0.2, &march);
  ASSERT_GT(expected, 1e-3);
  EXPECT_NEAR(sum.color.g / expected, 1.0, 2e-4);
}

TEST(LitOracle, DepthsOfRaysEndWhereTheyShould) {
  const Volume volume = makeVolume({9, 9, 9}, glm::dmat4(1.0), [](int, int, int) { return 1.0; });
  const ReferenceField field(volume, {.densityScale = 0.25});
  const MarchedRay ray{.origin = {-4.0, 4.0, 4.0}, .direction = {2.0, 0.0, 0.0}, .worldLength = 2.0};
  EXPECT_NEAR(marchDepth(field, ray, std::numeric_limits<double>::infinity()), 0.25 * 9.0, 1e-9);
  EXPECT_NEAR(marchDepth(field, ray, 4.0), 0.25 * 4.5, 1e-9);
  EXPECT_EQ(marchDepth(field, ray, 1.0), 0.0);
}

}  // namespace
}  // namespace freevoxels
