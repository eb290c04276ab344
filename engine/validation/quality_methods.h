#pragma once
// The drawing methods that are compared with the oracle, and the goals for their images.

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/render_settings.h"
#include "engine/scene/table_settings.h"
#include "engine/volume/classification.h"

namespace freevoxels {

/// Least PSNR in dB of premultiplied RGBA.
struct QualityGoals {
  std::optional<double> mean;       ///< over all views of all volumes
  std::optional<double> least;      ///< for every view of a volume that is not thin
  std::optional<double> leastThin;  ///< for every view of a thin volume
  /// Largest number of voxels along an edge for which `leastThin` is a goal: what is one voxel thick in a
  /// coarse volume is several thick in a fine one, and is shaded by angles that 26 directions cannot
  /// distinguish.
  int thinResolution = std::numeric_limits<int>::max();
  bool notBelowSorted = false;  ///< whether it must be as good as sorted blending in every view
};

struct QualityMethod {
  std::string name;
  TableSettings table;
  FrameSettings frame;  ///< without the size
  ClassificationOrder order = ClassificationOrder::Pre;  ///< the oracle uses Post
  QualityGoals goals;
};

/// All methods. The first is the default method; one is sorted blending.
const std::vector<QualityMethod>& qualityMethods();

/// Index of sorted blending in a list that contains it.
std::size_t sortedMethod(const std::vector<QualityMethod>& methods);

}  // namespace freevoxels
