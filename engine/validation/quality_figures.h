#pragma once
// The quality figures of the methods' images relative to the oracle's, and their tables and checks.

#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/validation/quality_methods.h"
#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"

namespace freevoxels {

/// The background of both images for FLIP. Over black, images that are mostly empty would be judged at
/// exposures at which nobody looks at them.
inline constexpr float kFlipBackground = 0.18f;

struct ImageFigures {
  double psnr = 0.0;  ///< in dB, of premultiplied RGBA
  double flip = 0.0;  ///< mean HDR-FLIP over grey
};
ImageFigures compareToOracle(const Image& image, const Image& oracle);

/// The figures of one scene.
struct QualityFigures {
  std::string scene;
  bool thin = false;
  int resolution = 0;  ///< voxels along an edge of the volume before it is cropped
  bool hasGoals = false;
  std::vector<QualityView> views;
  std::vector<std::vector<ImageFigures>> figures;  ///< [method][view]

  double meanPsnr(std::size_t method) const;
  double meanFlip(std::size_t method) const;
  /// The view in which the method's PSNR is least.
  std::size_t worstView(std::size_t method) const;
};

/// A table with a row for each method: mean, least, view of the least, FLIP.
ReportTable methodTable(const QualityFigures& scene, const std::vector<QualityMethod>& methods);
/// A table of the PSNR of every method in every view.
ReportTable viewTable(const QualityFigures& scene, const std::vector<QualityMethod>& methods);

/// Checks of the goals that apply to a single scene.
std::vector<Check> sceneChecks(const QualityFigures& scene, const std::vector<QualityMethod>& methods);

/// Least and largest PSNR of each method on each scene, and the mean over all views of all scenes with its
/// goal. Scenes without goals do not count for that.
ReportSection summariseQuality(const std::vector<QualityFigures>& scenes,
                               const std::vector<QualityMethod>& methods);

}  // namespace freevoxels
