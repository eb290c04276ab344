#pragma once
// How near the oracle the methods' pictures are: the figures, and what is read off them.

#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/validation/quality_methods.h"
#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"

namespace freevoxels {

/// What both pictures are laid over for FLIP: over black, pictures that are mostly empty would be judged at
/// exposures that nobody looks at them with.
inline constexpr float kFlipBackground = 0.18f;

struct PictureFigures {
  double psnr = 0.0;  ///< dB, of premultiplied RGBA
  double flip = 0.0;  ///< mean HDR-FLIP over grey
};
PictureFigures compareToOracle(const Image& picture, const Image& oracle);

/// Of one scene.
struct QualityFigures {
  std::string scene;
  bool thin = false;
  int resolution = 0;  ///< voxels along an edge of the volume, before it was cropped
  bool hasGoals = false;
  std::vector<QualityView> views;
  std::vector<std::vector<PictureFigures>> figures;  ///< [method][view]

  double meanPsnr(std::size_t method) const;
  double meanFlip(std::size_t method) const;
  /// View where the method's PSNR is least.
  std::size_t worstView(std::size_t method) const;
};

/// Mean, least, where it is least, FLIP; a row a method.
ReportTable methodTable(const QualityFigures& scene, const std::vector<QualityMethod>& methods);
/// PSNR of every method in every view.
ReportTable viewTable(const QualityFigures& scene, const std::vector<QualityMethod>& methods);

/// The goals that a single scene can meet or miss.
std::vector<Check> sceneChecks(const QualityFigures& scene, const std::vector<QualityMethod>& methods);

/// Least and largest PSNR of each method on each scene, the mean over all views of all scenes, and the goals
/// for it. Scenes without goals do not count for those.
ReportSection summariseQuality(const std::vector<QualityFigures>& scenes,
                               const std::vector<QualityMethod>& methods);

}  // namespace freevoxels
