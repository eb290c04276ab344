#pragma once
// The ways to draw that are compared with the oracle, and what their pictures have to reach.

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/render_settings.h"
#include "engine/scene/table_settings.h"
#include "engine/volume/classification.h"

namespace freevoxels {

/// PSNR in dB, of premultiplied RGBA.
struct QualityGoals {
  std::optional<double> mean;       ///< over all views of all volumes
  std::optional<double> least;      ///< of any view of a volume that is not thin
  std::optional<double> leastThin;  ///< of any view of a thin one
  /// `leastThin` is no goal for volumes of more voxels along an edge: what is one voxel thick in a coarse
  /// volume is several thick in a fine one, and shades by angles between which 26 directions cannot tell.
  int thinResolution = std::numeric_limits<int>::max();
  bool notBelowSorted = false;  ///< at least as good as sorted blending in every view
};

struct QualityMethod {
  std::string name;
  TableSettings table;
  FrameSettings frame;  ///< apart from the size
  ClassificationOrder order = ClassificationOrder::Pre;  ///< that of the oracle is Post
  QualityGoals goals;
};

/// The first is the default method. One is sorted blending.
const std::vector<QualityMethod>& qualityMethods();

/// Where in a list that holds one sorted blending is.
std::size_t sortedMethod(const std::vector<QualityMethod>& methods);

}  // namespace freevoxels
