// Subr et al. 2007, Section 3.1, Eq. 5, as a recurrence in optical depth along lattice steps d:
//   tau_d(v) = tau_d(v + d) + sigma(v + d) * |M d|,   0 where v + d is outside of the volume.
// The 72 directions half-way between those of the paper have steps of two layers. The layer in the middle of
// a step has its extinction from the voxels next to the line, and counts even where v + d is outside:
//   tau_d(v) = tau_d(v + d) + (sigma(v + d) + sigma(v + d/2)) * |M d| / 2.

#include "engine/reference/reference_table.h"

#include <tbb/parallel_for.h>

#include "engine/core/error.h"
#include "engine/volume/voxel_classifier.h"

namespace freevoxels {

namespace {

/// The i-th coordinate of a line of n voxels, in an order in which v + step precedes v.
int towards(int i, int n, int step) {
  return step > 0 ? n - 1 - i : i;
}

/// Extinction of the voxels of a volume, with 0 around it.
class Field {
 public:
  Field(const Volume& volume, const std::vector<double>& extinction)
      : volume_(volume), extinction_(extinction) {}
  bool contains(glm::ivec3 v) const {
    const glm::ivec3 n = volume_.dimensions;
    return v.x >= 0 && v.x < n.x && v.y >= 0 && v.y < n.y && v.z >= 0 && v.z < n.z;
  }
  double operator()(glm::ivec3 v) const { return contains(v) ? extinction_[volume_.at(v.x, v.y, v.z)] : 0.0; }
  /// The mean extinction of the voxels nearest to v + step / 2: one coordinate for an even component of the
  /// step, two for an odd one.
  double halfway(glm::ivec3 v, glm::ivec3 step) const {
    const glm::dvec3 middle = 0.5 * glm::dvec3(step);
    const glm::ivec3 low(glm::floor(middle)), high(glm::ceil(middle));
    double sum = 0.0;  // over eight voxels, some of which are the same
    for (const int z : {low.z, high.z})
      for (const int y : {low.y, high.y})
        for (const int x : {low.x, high.x}) sum += (*this)(v + glm::ivec3(x, y, z));
    return sum / 8.0;
  }

 private:
  const Volume& volume_;
  const std::vector<double>& extinction_;
};

}  // namespace

std::vector<double> referenceExtinction(const Volume& volume, const Classification& classification) {
  std::vector<double> extinction;
  extinction.reserve(volume.voxelCount());
  const VoxelClassifier classifier(classification, volume);
  const glm::ivec3 n = volume.dimensions;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) extinction.push_back(classifier.at({x, y, z}).extinction);
  return extinction;
}

std::vector<double> referenceOpticalDepth(const Volume& volume, const std::vector<double>& extinction,
                                          DirectionSet set, int direction, bool pathLengthCorrection) {
  FV_CHECK_EQ(extinction.size(), volume.voxelCount());
  const Field sigma(volume, extinction);
  const glm::ivec3 n = volume.dimensions;
  const glm::ivec3 cell = directionCell(set, direction);
  const int layers = cell % int(set) == glm::ivec3(0) ? 1 : int(set);  // in a lattice step
  const glm::ivec3 d = cell * layers / int(set);
  const double layer = stepLength(volume.indexToWorld, directionAt(set, direction), pathLengthCorrection);
  std::vector<double> depth(volume.voxelCount(), 0.0);
  for (int k = 0; k < n.z; ++k)
    for (int j = 0; j < n.y; ++j)
      for (int i = 0; i < n.x; ++i) {
        const glm::ivec3 v(towards(i, n.x, d.x), towards(j, n.y, d.y), towards(k, n.z, d.z));
        const glm::ivec3 next = v + d;
        double& here = depth[volume.at(v.x, v.y, v.z)];
        if (sigma.contains(next)) here = depth[volume.at(next.x, next.y, next.z)] + sigma(next) * layer;
        if (layers == 2) here += sigma.halfway(v, d) * layer;
      }
  return depth;
}

std::vector<std::vector<std::uint8_t>> referenceTable(const Volume& volume,
                                                      const std::vector<double>& extinction,
                                                      const TableSettings& settings) {
  const int directions = directionCount(settings.directions);
  std::vector<std::vector<std::uint8_t>> table(std::size_t(directions), std::vector<std::uint8_t>{});
  tbb::parallel_for(0, directions, [&](int direction) {
    std::vector<std::uint8_t>& bytes = table[std::size_t(direction)];
    bytes.reserve(volume.voxelCount());
    for (const double depth : referenceOpticalDepth(volume, extinction, settings.directions, direction,
                                                    settings.pathLengthCorrection))
      bytes.push_back(std::uint8_t(encodeOpticalDepth(settings.code, depth)));
  });
  return table;
}

}  // namespace freevoxels
