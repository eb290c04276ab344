#pragma once
// Measures attenuation leakage: Subr et al. 2007, Section 4.1, Eq. 8 and 9.

#include <vector>

#include "engine/validation/report.h"
#include "engine/validation/stage_outputs.h"

namespace freevoxels {

struct LayerStacks {
  std::vector<double> opacities{0.1, 0.3, 0.6, 0.9};  ///< opacities of a layer, below 1
  std::vector<int> layers{1, 2, 4, 8, 16};            ///< ascending numbers of layers, at most 16, as the eye is 20 voxels up
};

/// The transmittance of stacks of equal layers seen straight on, in the middle of a voxel and between four
/// voxels: normalised, and blended back to front, which Eq. 9 predicts.
ReportSection leakageOfLayers(const StageMaker& make, const LayerStacks& stacks);

}  // namespace freevoxels
