// Light of all orders of scattering on the CPU, against closed forms.

#include "engine/reference/reference_scattering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "engine/scene/sphere_quadrature.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/volume/procedural.h"

namespace freevoxels {
namespace {

Volume fullBox(glm::ivec3 n) {
  return makeVolume(n, glm::dmat4(1.0), [](int, int, int) { return 1.0; });
}

TEST(SphereQuadrature, WeightsIntegrateSecondMomentsAlsoOfOtherCellsThanCubes) {
  glm::dmat4 stretched(1.0), sheared(1.0);
  stretched[2][2] = 1.7;
  sheared[1][0] = 0.3;
  for (const glm::dmat4& transform : {glm::dmat4(1.0), glm::dmat4(0.01), stretched, sheared}) {
    double sum = 0.0;
    glm::dmat3 moments(0.0);
    for (const QuadratureDirection& direction : sphereQuadrature(transform)) {
      EXPECT_GT(direction.weight, 0.0);
      sum += direction.weight;
      moments += direction.weight * glm::outerProduct(direction.unit, direction.unit);
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(moments[i][j], i == j ? 1.0 / 3.0 : 0.0, 1e-12);
  }
}

TEST(ScatteringMedium, CellsHoldTheMeansOfTheirVoxels) {
  const Volume volume = makeVolume({130, 70, 65}, glm::dmat4(1.0), [](int x, int y, int z) { return 0.1 * ((x + 2 * y + 3 * z) % 7); });
  const Classification classification{.densityScale = 2.0, .albedo = {0.9f, 0.5f, 0.1f}};
  const ScatteringMedium medium(volume, classification);
  EXPECT_LE(medium.grid().count(), kMaxScatteringCells);
  EXPECT_LE(medium.directGrid().count(), kMaxDirectCells);
  EXPECT_EQ(medium.grid().edge % medium.directGrid().edge, 0);
  double whole = 0.0;
  for (int z = 0; z < 65; ++z)
    for (int y = 0; y < 70; ++y)
      for (int x = 0; x < 130; ++x) whole += 2.0 * double(volume.scalar(x, y, z));
  for (const ScatteringMedium& level : {medium, medium.coarser()}) {
    double sum = 0.0, red = 0.0;
    for (const ScatteringMedium::Cell& cell : level.cells()) {
      sum += cell.extinction;
      red += cell.scattering.r;
    }
    const double voxels = std::pow(double(level.grid().edge), 3.0);
    EXPECT_NEAR(sum * voxels / whole, 1.0, 1e-5);
    EXPECT_NEAR(red * voxels / (0.9 * whole), 1.0, 1e-5);
  }
  // In parts that end within cells.
  ScatteringMedium parts(volume.dimensions, volume.indexToWorld);
  for (const int first : {0, 33}) {
    const glm::ivec3 begin(0, 0, first), end(130, 70, first == 0 ? 33 : 65);
    const Volume part =
        makeVolume(end - begin, glm::dmat4(1.0), [&](int x, int y, int z) { return double(volume.scalar(x, y, z + first)); });
    parts.add(part, begin, classification);
  }
  for (std::size_t i = 0; i < medium.cells().size(); ++i) EXPECT_NEAR(parts.cells()[i].extinction, medium.cells()[i].extinction, 1e-6);
}

/// A uniform sky around a medium that absorbs nothing lights every place as if nothing was there, whatever the phase function.
TEST(ReferenceScattering, WhatAbsorbsNothingIsAsBrightAsTheSkyAroundIt) {
  const ScatteringMedium medium(fullBox({9, 7, 8}), {.densityScale = 0.4, .albedo = glm::vec3(1.0f)});
  for (const double g : {0.0, 0.6, -0.4}) {
    const ScatteredField field =
        referenceScattering(medium, {.lights = {}, .ambient = {0.5, 1.0, 2.0}, .phaseG = g, .scattering = kAllOrders}, 1e-9);
    for (const glm::dvec3& mean : field.mean)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], c == 0 ? 0.5 : c == 1 ? 1.0 : 2.0, 1e-5);
  }
}

/// Without absorption what is emitted goes out: the flux through the faces of a box, from the cells at them, is the power of what shines in
/// it.
TEST(ReferenceScattering, WhatIsEmittedGoesOutWhereNothingIsAbsorbed) {
  constexpr int kCells = 24;
  constexpr double kSigma = 0.15;  // cells so thin that their errors do not matter
  Volume volume = fullBox(glm::ivec3(kCells));
  volume.temperature = TemperatureGrid{.name = "", .values = ScalarBricks::make(glm::ivec3(kCells), [](glm::ivec3 v) {
                                                     return glm::length(glm::dvec3(v) - 11.5) < 4.0 ? 2000.0f : 0.0f;
                                                   })};
  summariseValues(*volume.temperature);
  const ScatteringMedium medium(volume, {.densityScale = kSigma, .albedo = glm::vec3(1.0f), .emission = Emission{.strength = 1.0}});
  // With a phase function, so that fluxes are kept: one that hardly is one.
  const ScatteredField field = referenceScattering(medium, {.lights = {}, .phaseG = -1e-6, .scattering = kAllOrders}, 1e-8);
  double emitted = 0.0, leaving = 0.0;
  glm::ivec3 cell;
  for (cell.z = 0; cell.z < kCells; ++cell.z)
    for (cell.y = 0; cell.y < kCells; ++cell.y)
      for (cell.x = 0; cell.x < kCells; ++cell.x) {
        const std::size_t i = medium.grid().index(cell);
        emitted += medium.cells()[i].emission.g;
        // Between this cell and the one around the box of those that lie within four cells of its faces.
        for (int axis = 0; axis < 3; ++axis)
          for (const int face : {3, kCells - 4}) {
            bool onFace = cell[axis] == face;
            for (int other = 0; other < 3; ++other) onFace = onFace && cell[other] >= 3 && cell[other] <= kCells - 4;
            double share = 1.0;  // of the cells at the borders of the face half the area
            for (int other = 0; other < 3; ++other)
              if (other != axis && (cell[other] == 3 || cell[other] == kCells - 4)) share *= 0.5;
            if (onFace) leaving += share * field.fluxes[i][std::size_t(axis)].g * (face == 3 ? -1.0 : 1.0);
          }
      }
  EXPECT_NEAR(leaving / emitted, 1.0, 0.01);
}

/// H(1) of Chandrasekhar 1960, Section 37, for isotropic scattering, by iteration of his Eq. 22 with the midpoint rule.
double chandrasekharH(double albedo) {
  constexpr int kPoints = 400;
  std::vector<double> h(kPoints, 1.0);
  const auto at = [&](double mu) {
    double sum = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const double other = (i + 0.5) / kPoints;
      sum += h[std::size_t(i)] * other / (mu + other) / kPoints;
    }
    return 1.0 / (std::sqrt(1.0 - albedo) + 0.5 * albedo * sum);
  };
  for (int iteration = 0; iteration < 60; ++iteration) {
    std::vector<double> next;
    for (int i = 0; i < kPoints; ++i) next.push_back(at((i + 0.5) / kPoints));
    h = next;
  }
  return at(1.0);
}

/// Light on a half space at right angles comes back with the radiance w / (8 pi) E H(1)² along the normal. Near the face the radiance
/// changes abruptly from the directions that come in to those that go out, which 26 directions cannot show.
TEST(ReferenceScattering, AHalfSpaceReflectsWhatChandrasekharSays) {
  for (const double albedo : {0.5, 0.8}) {
    const auto reflected = [&](double sigma) {
      // So wide that what leaves at the sides does not matter in the middle.
      const int depth = int(10.0 / sigma), width = int(15.0 / sigma) / 2 * 2 + 1;
      const ScatteringMedium medium(fullBox({width, width, depth}), {.densityScale = sigma, .albedo = glm::vec3(float(albedo))});
      const ScatteredField field = referenceScattering(medium, {.lights = {{.place = {0.0, 0.0, -1.0}}}, .scattering = kAllOrders}, 1e-5);
      double sum = 0.0;
      constexpr int kSteps = 4000;
      for (int i = 0; i < kSteps; ++i) {
        const double z = depth * (i + 0.5) / kSteps, tau = sigma * z;  // from the face
        const glm::dvec3 voxel(0.5 * (width - 1), 0.5 * (width - 1), z - 0.5);
        const double scattered = std::exp(-tau) + field.at(voxel, {0.0, 0.0, -1.0}).r;  // irradiance / 4 pi is 1
        sum += albedo * std::exp(-tau) * scattered * sigma * depth / kSteps;
      }
      return sum;
    };
    const double expected = 0.5 * albedo * std::pow(chandrasekharH(albedo), 2.0);  // for E / (4 pi) = 1
    EXPECT_NEAR(reflected(0.25) / expected, 1.0, 0.05) << albedo;
  }
}

TEST(ReferenceScattering, OneOrderOfASkyIsWhatReachesTheMediumUnscattered) {
  const ScatteringMedium medium(fullBox({3, 3, 3}), {.densityScale = 1e-6});
  const ScatteredField field = referenceScattering(medium, {.lights = {}, .ambient = glm::dvec3(2.0), .scattering = 1});
  for (const glm::dvec3& mean : field.mean) EXPECT_NEAR(mean.g, 2.0, 1e-4);
  const ScatteredField none = referenceScattering(medium, {.lights = {{}}, .scattering = 1});
  for (const glm::dvec3& mean : none.mean) EXPECT_EQ(mean.g, 0.0);
}

}  // namespace
}  // namespace freevoxels
