// The table against closed forms (Beer-Lambert) and against a march of every voxel's line by itself.

#include "engine/reference/reference_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "engine/volume/procedural.h"

namespace freevoxels {
namespace {

glm::dmat4 anisotropic() {
  glm::dmat4 matrix(1.0);
  matrix[0][0] = 0.5;
  matrix[1][1] = 0.2;
  matrix[2][2] = 1.3;
  return matrix;
}

glm::dmat4 sheared() {
  glm::dmat4 matrix = anisotropic();
  matrix[1][0] = 0.4;
  matrix[2][1] = -0.3;
  matrix[3] = {10.0, -3.0, 2.0, 1.0};
  return matrix;
}

bool inside(glm::ivec3 v, glm::ivec3 n) {
  return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < n.x && v.y < n.y && v.z < n.z;
}

constexpr DirectionSet kSets[] = {DirectionSet::Directions26, DirectionSet::Directions98};

/// Calls `check(voxel position, linear index)` for all voxels.
template <typename Check>
void forEachVoxel(const Volume& volume, Check&& check) {
  for (int z = 0; z < volume.dimensions.z; ++z)
    for (int y = 0; y < volume.dimensions.y; ++y)
      for (int x = 0; x < volume.dimensions.x; ++x) check(glm::ivec3(x, y, z), volume.at(x, y, z));
}

/// How many layers of voxels lie between v and the outside along the direction of a cell. Nothing where v's
/// line leaves the box through a side before: it may do so between two voxels, of which one is outside.
std::optional<int> layersAhead(glm::ivec3 v, glm::ivec3 cell, glm::ivec3 n, int k) {
  int ahead = std::numeric_limits<int>::max(), sideways = ahead;
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] == 0) continue;
    const int voxels = cell[axis] > 0 ? n[axis] - 1 - v[axis] : v[axis];
    int& layers = std::abs(cell[axis]) == k ? ahead : sideways;
    layers = std::min(layers, voxels * k / std::abs(cell[axis]));
  }
  return ahead <= sideways ? std::optional(ahead) : std::nullopt;
}

TEST(ReferenceTable, HomogeneousBoxFollowsBeerLambertInAllDirections) {
  const double sigma = 0.37;
  for (const DirectionSet set : kSets)
    for (const glm::dmat4& transform : {glm::dmat4(1.0), anisotropic(), sheared()}) {
      const Volume volume = makeVolume({5, 7, 4}, transform, [](int, int, int) { return 1.0; });
      const std::vector<double> extinction(volume.voxelCount(), sigma);
      for (int d = 0; d < directionCount(set); ++d) {
        const double length = glm::length(glm::dmat3(transform) * directionAt(set, d));
        const std::vector<double> depth = referenceOpticalDepth(volume, extinction, set, d, true);
        int checked = 0;
        forEachVoxel(volume, [&](glm::ivec3 v, std::size_t i) {
          const auto layers = layersAhead(v, directionCell(set, d), volume.dimensions, int(set));
          if (!layers) return;
          ++checked;
          EXPECT_NEAR(depth[i], sigma * length * *layers, 1e-12);
        });
        EXPECT_GE(checked, int(volume.voxelCount()) / 4);
      }
    }
}

TEST(ReferenceTable, WithoutPathLengthCorrectionItIsThePapersProduct) {
  const Volume volume = makeVolume({4, 4, 4}, sheared(), [](int, int, int) { return 1.0; });
  const double alpha = 0.3;
  const double size = std::cbrt(0.5 * 0.2 * 1.3);
  const std::vector<double> extinction(volume.voxelCount(), -std::log1p(-alpha) / size);
  for (const DirectionSet set : kSets)
    for (int d = 0; d < directionCount(set); ++d) {
      const std::vector<double> depth = referenceOpticalDepth(volume, extinction, set, d, false);
      forEachVoxel(volume, [&](glm::ivec3 v, std::size_t i) {  // Eq. 5
        const auto layers = layersAhead(v, directionCell(set, d), volume.dimensions, int(set));
        if (!layers) return;
        EXPECT_NEAR(std::exp(-depth[i]), std::pow(1.0 - alpha, *layers), 1e-12);
      });
    }
}

/// Extinction at a point on a voxel or half-way between voxels in some components, 0 around the volume: half
/// of each neighbour.
double extinctionAt(const Volume& volume, const std::vector<double>& extinction, glm::dvec3 point) {
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] == std::floor(point[axis])) continue;
    glm::dvec3 half(0.0);
    half[axis] = 0.5;
    return (extinctionAt(volume, extinction, point - half) + extinctionAt(volume, extinction, point + half)) /
           2;
  }
  const glm::ivec3 v(point);
  return inside(v, volume.dimensions) ? extinction[volume.at(v.x, v.y, v.z)] : 0.0;
}

TEST(ReferenceTable, EqualsTheMarchOfEveryVoxelsLine) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  for (const glm::ivec3 n :
       {glm::ivec3(1, 1, 1), glm::ivec3(1, 9, 1), glm::ivec3(7, 5, 11), glm::ivec3(2, 13, 3)}) {
    const Volume volume = makeVolume(n, sheared(), [](int, int, int) { return 0.0; });
    std::vector<double> extinction(volume.voxelCount());
    for (double& sigma : extinction) sigma = uniform(random) < 0.3 ? 0.0 : 4.0 * uniform(random);
    for (const DirectionSet set : kSets)
      for (const bool correction : {true, false}) {
        const auto linear = referenceTable(volume, extinction, {AttenuationCode::Linear8, correction, set});
        const auto depth = referenceTable(volume, extinction, {AttenuationCode::Depth8, correction, set});
        ASSERT_EQ(linear.size(), std::size_t(directionCount(set)));
        for (int d = 0; d < directionCount(set); ++d) {
          const glm::dvec3 step = directionAt(set, d);
          const double length =
              correction ? glm::length(glm::dmat3(sheared()) * step) : std::cbrt(0.5 * 0.2 * 1.3);
          forEachVoxel(volume, [&](glm::ivec3 v, std::size_t i) {
            double transmittance = 1.0;
            for (int layer = 1; layer < 14; ++layer)
              transmittance *=
                  std::exp(-extinctionAt(volume, extinction, glm::dvec3(v) + double(layer) * step) * length);
            const double code = 255.0 * std::sqrt(std::min(1.0, -std::log(transmittance) / 16.0));
            // Rounding may fall to either side of a half.
            EXPECT_LE(std::abs(linear[std::size_t(d)][i] - 255.0 * transmittance), 0.5 + 1e-9);
            EXPECT_LE(std::abs(depth[std::size_t(d)][i] - code), 0.5 + 1e-9);
          });
        }
      }
  }
}

TEST(ReferenceTable, ExtinctionFollowsTheClassification) {
  Volume volume = makeVolume({3, 1, 1}, glm::dmat4(1.0), [](int x, int, int) { return double(x) - 1.0; });
  Classification classification;
  classification.densityScale = 2.5;
  EXPECT_EQ(referenceExtinction(volume, classification), (std::vector<double>{0.0, 0.0, 2.5}));
  volume.scalars.set({2, 0, 0}, kInactiveVoxel);
  EXPECT_EQ(referenceExtinction(volume, classification), (std::vector<double>{0.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace freevoxels
