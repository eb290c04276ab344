#include "engine/volume/cell_extinctions.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freevoxels {

namespace {

/// Extinction by scalar: exact without a transfer function, otherwise from a table. Scalars beyond the volume's range, which means of coarse
/// levels may be, have the extinction of its end.
class ExtinctionTable {
 public:
  ExtinctionTable(const Volume& volume, const Classification& classification)
      : scale_(float(std::min(classification.densityScale, double(std::numeric_limits<float>::max())))), low_(volume.minimum) {
    if (!classification.transferFunction) return;
    if (volume.maximum > volume.minimum) perScalar_ = double(kIntervals) / (double(volume.maximum) - low_);
    for (int i = 0; i <= kIntervals; ++i) {
      const double scalar = std::lerp(double(volume.minimum), double(volume.maximum), double(i) / kIntervals);
      values_.push_back(float(classify(classification, float(scalar)).extinction));
    }
  }
  float at(float scalar) const {
    if (scalar == kInactiveVoxel) return 0.0f;
    if (values_.empty()) return std::min(std::max(scalar, 0.0f) * scale_, float(kMaximumExtinction));
    return values_[std::size_t(std::clamp((double(scalar) - low_) * perScalar_, 0.0, double(kIntervals)) + 0.5)];
  }

 private:
  static constexpr int kIntervals = 4096;
  float scale_;
  double low_, perScalar_ = 0.0;  ///< a float does not hold the extent of any range, or its inverse
  std::vector<float> values_;
};

}  // namespace

std::vector<float> cellExtinctions(const Volume& volume, const Classification& classification, int edge) {
  const ExtinctionTable table(volume, classification);
  const glm::ivec3 n = volume.dimensions, cells = (n + edge - 1) / edge;
  std::vector<float> result(std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z), 0.0f);
  const float share = 1.0f / float(edge * edge * edge);
  tbb::parallel_for(0, cells.z, [&](int plane) {
    std::vector<float> row(std::size_t(n.x));
    for (int z = plane * edge; z < std::min((plane + 1) * edge, n.z); ++z)
      for (int y = 0; y < n.y; ++y) {
        volume.scalars.copyRow(y, z, row);
        float* const to = &result[std::size_t(cells.x) * (std::size_t(y / edge) + std::size_t(cells.y) * std::size_t(plane))];
        for (int x = 0; x < n.x; ++x) to[x / edge] += share * table.at(row[std::size_t(x)]);
      }
  });
  return result;
}

}  // namespace freevoxels
