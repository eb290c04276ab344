#pragma once
// Images compared with the oracle (engine/reference/oracle.h), for each drawing method.

#include <span>

#include "engine/validation/quality_figures.h"
#include "engine/validation/quality_methods.h"
#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"
#include "engine/validation/stage_outputs.h"

namespace freevoxels {

struct QualityRun {
  std::span<const QualityView> views;
  int imageEdge = 128;    ///< edge of the square images in pixels
  bool hasGoals = false;  ///< whether the methods' goals apply to volumes and images of this size
};

struct QualityResult {
  ReportSection section;
  QualityFigures figures;
};

/// Draws every view once by the oracle and once by each method. Reports checks where there are goals, tables,
/// and the images of the view in which the first method is worst.
QualityResult imageQuality(const StageMaker& make, const QualityScene& scene, const std::vector<QualityMethod>& methods,
                           const QualityRun& run);

/// The largest step between neighbours of a series of at least two points. `where` is the x of the earlier of the two.
Check largestJump(const std::vector<glm::dvec2>& series, double tolerance, std::string name);

/// A quarter of a turn in `frames` steps at elevation 10 from one distance: PSNR of the first method, whose RMS error may differ by a
/// thousandth from frame to frame, of the others with goals for every view, and of sorted blending.
ReportSection turntableQuality(const StageMaker& make, const QualityScene& scene, int frames, int imageEdge);

}  // namespace freevoxels
