#pragma once
// Square images of a scene from many cameras, for comparison.

#include <vector>

#include "engine/validation/quality_methods.h"
#include "engine/validation/quality_scenes.h"
#include "engine/validation/stage_outputs.h"

namespace freevoxels {

/// The oracle's tolerance: its images then have 80 dB relative to those with a quarter of this tolerance, in
/// a third of the time, and what is measured with them is below 65 dB.
inline constexpr double kQualityTolerance = 4e-3;

/// Scales differences so that those below 1/8 can be distinguished.
inline constexpr float kDifferenceGain = 8.0f;

/// An opaque image of kDifferenceGain |test - reference| of the colours.
Image visibleDifference(const Image& test, const Image& reference);

std::vector<Image> oracleImages(const QualityScene& scene, const std::vector<Camera>& cameras, glm::ivec2 size);

std::vector<Image> methodImages(const StageMaker& make, const QualityScene& scene, const QualityMethod& method,
                                const std::vector<Camera>& cameras, glm::ivec2 size);

}  // namespace freevoxels
