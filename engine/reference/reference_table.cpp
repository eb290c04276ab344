// Subr et al. 2007, Section 3.1, Eq. 5, as a recurrence in optical depth:
//   tau_d(v) = tau_d(v + d) + sigma(v + d) * |M d|,   0 where v + d is outside of the volume.

#include "engine/reference/reference_table.h"

#include <tbb/parallel_for.h>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// The i-th coordinate of a line of n voxels in an order that has v + step before v.
int towards(int i, int n, int step) {
  return step > 0 ? n - 1 - i : i;
}

}  // namespace

std::vector<double> referenceExtinction(const Volume& volume, const Classification& classification) {
  std::vector<double> extinction;
  extinction.reserve(volume.values.size());
  for (const float value : volume.values) extinction.push_back(classify(classification, value).extinction);
  return extinction;
}

std::vector<double> referenceOpticalDepth(const Volume& volume, const std::vector<double>& extinction,
                                          int direction, bool pathLengthCorrection) {
  FV_CHECK_EQ(extinction.size(), volume.voxelCount());
  const glm::ivec3 n = volume.dimensions;
  const glm::ivec3 d = directionAt(direction);
  const double step = stepLength(volume.indexToWorld, d, pathLengthCorrection);
  std::vector<double> depth(volume.voxelCount(), 0.0);
  for (int k = 0; k < n.z; ++k)
    for (int j = 0; j < n.y; ++j)
      for (int i = 0; i < n.x; ++i) {
        const int x = towards(i, n.x, d.x), y = towards(j, n.y, d.y), z = towards(k, n.z, d.z);
        const int nextX = x + d.x, nextY = y + d.y, nextZ = z + d.z;
        if (nextX < 0 || nextX >= n.x || nextY < 0 || nextY >= n.y || nextZ < 0 || nextZ >= n.z) continue;
        const std::size_t next = volume.at(nextX, nextY, nextZ);
        depth[volume.at(x, y, z)] = depth[next] + extinction[next] * step;
      }
  return depth;
}

std::vector<std::vector<std::uint8_t>> referenceTable(const Volume& volume,
                                                      const std::vector<double>& extinction,
                                                      AttenuationCode code, bool pathLengthCorrection) {
  std::vector<std::vector<std::uint8_t>> table(kDirectionCount);
  tbb::parallel_for(0, kDirectionCount, [&](int direction) {
    std::vector<std::uint8_t>& bytes = table[std::size_t(direction)];
    bytes.reserve(volume.voxelCount());
    for (const double depth : referenceOpticalDepth(volume, extinction, direction, pathLengthCorrection))
      bytes.push_back(std::uint8_t(encodeOpticalDepth(code, depth)));
  });
  return table;
}

}  // namespace freevoxels
