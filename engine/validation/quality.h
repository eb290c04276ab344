#pragma once
// Pictures against the oracle (engine/reference/oracle.h): how near each method comes to what should be seen.

#include <span>

#include "engine/validation/quality_figures.h"
#include "engine/validation/quality_methods.h"
#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"
#include "engine/validation/stage_outputs.h"

namespace freevoxels {

struct QualityRun {
  std::span<const QualityView> views;
  int pictureEdge = 128;  ///< pixels, of square pictures
  bool hasGoals = false;  ///< whether the methods' goals are meant for volumes and pictures of this size
};

struct QualityResult {
  ReportSection section;
  QualityFigures figures;
};

/// Every view is drawn once by the oracle and once by each method. Checks where there are goals, tables, and
/// pictures of the view where the first method is worst.
QualityResult pictureQuality(const StageMaker& make, const QualityScene& scene,
                             const std::vector<QualityMethod>& methods, const QualityRun& run);

/// The largest step between neighbours of a closed series: the last one's neighbour is the first. `where` is
/// the x of the earlier of the two.
Check largestJump(const std::vector<glm::dvec2>& series, double tolerance, std::string name);

/// A turn at elevation 10 in as many frames from one distance: PSNR of the first method, whose frames may
/// differ by 1 dB from their neighbours, of the others with goals for every view, and of sorted blending.
ReportSection turntableQuality(const StageMaker& make, const QualityScene& scene, int frames,
                               int pictureEdge);

}  // namespace freevoxels
