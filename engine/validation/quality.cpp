#include "engine/validation/quality.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "engine/core/error.h"
#include "engine/image/flip.h"
#include "engine/image/metrics.h"
#include "engine/scene/orbit.h"
#include "engine/validation/max_error.h"
#include "engine/validation/quality_images.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

constexpr double kTurntableElevation = 10.0;
constexpr double kMaxJump = 1e-3;  ///< of the RMS error: a quarter of a code of 8 bits, which is 1 dB at 41 dB

std::vector<ImageFigures> figuresOf(const std::vector<Image>& images, const std::vector<Image>& oracle) {
  std::vector<ImageFigures> figures;
  for (std::size_t i = 0; i < images.size(); ++i) figures.push_back(compareToOracle(images[i], oracle[i]));
  return figures;
}

Image flipErrorImage(const Image& test, const Image& reference) {
  const glm::vec3 grey(kFlipBackground);
  const Image shown = compositeOver(reference, grey);
  return magmaImage(hdrFlip(compositeOver(test, grey), shown, flipExposures(shown)));
}

ImageRow worstImages(const std::string& view, const Image& oracle, const QualityMethod& first, const Image& image, const Image& sorted) {
  return {.caption = fmt::format("The view {}, where the method \"{}\" is worst", view, first.name),
          .images = {{"oracle", oracle},
                     {first.name, image},
                     {fmt::format("{}: {:g} times the difference", first.name, kDifferenceGain), visibleDifference(image, oracle)},
                     {first.name + ": HDR-FLIP, black 0, yellow 1", flipErrorImage(image, oracle)},
                     {"sorted", sorted}},
          .background = {}};
}

QualityScene classifiedAfter(QualityScene scene) {
  scene.classification.order = ClassificationOrder::Post;
  return scene;
}

const char* const kQualityText =
    "Images against the oracle, a converged ray march on the CPU: until doubling its rays changes no pixel "
    "by 0.004, which is 80 dB from a quarter of that, of scalars that are classified after interpolation, as the first method's are. PSNR "
    "is of premultiplied RGBA; HDR-FLIP "
    "is the mean of the map, with both images over a grey of 0.18: over black, images that are mostly "
    "empty would be judged at exposures that nobody looks at them with. \"nearest, additive (paper)\" is the "
    "method of Subr et al. 2007 (Eq. 5 and 10); \"sorted\" is back-to-front alpha blending (Eq. 9).";

std::vector<double> turntablePsnr(const StageMaker& make, const QualityScene& scene,
                                  const QualityMethod& method, const std::vector<Camera>& cameras,
                                  const std::vector<Image>& oracle) {
  std::vector<double> psnr;
  const std::vector<Image> images = methodImages(make, scene, method, cameras, oracle.front().size);
  for (std::size_t i = 0; i < images.size(); ++i) psnr.push_back(compareImages(images[i], oracle[i]).psnr);
  return psnr;
}

}  // namespace

QualityResult imageQuality(const StageMaker& make, const QualityScene& scene, const std::vector<QualityMethod>& methods,
                           const QualityRun& run) {
  const glm::ivec2 size(run.imageEdge);
  std::vector<Camera> cameras;
  for (const QualityView& view : run.views) cameras.push_back(viewCamera(scene.volume, view));
  const std::vector<Image> oracle = oracleImages(classifiedAfter(scene), cameras, size);
  QualityFigures figures{.scene = scene.name,
                         .thin = scene.thin,
                         .resolution = scene.resolution,
                         .hasGoals = run.hasGoals,
                         .views = {run.views.begin(), run.views.end()},
                         .figures = {}};
  std::vector<std::vector<Image>> images;
  for (const QualityMethod& method : methods) {
    images.push_back(methodImages(make, scene, method, cameras, size));
    figures.figures.push_back(figuresOf(images.back(), oracle));
  }
  const std::size_t worst = figures.worstView(0);
  ReportSection section{.title = fmt::format("Image quality: {}, {}x{} pixels", scene.name, size.x, size.y),
                        .text = kQualityText,
                        .checks = sceneChecks(figures, methods),
                        .tables = {methodTable(figures, methods)},
                        .plots = {},
                        .imageRows = {worstImages(viewText(run.views[worst]), oracle[worst], methods.front(), images.front()[worst],
                                                  images[sortedMethod(methods)][worst])}};
  if (run.views.size() > 1) section.tables.push_back(viewTable(figures, methods));
  return {std::move(section), std::move(figures)};
}

Check largestJump(const std::vector<glm::dvec2>& series, double tolerance, std::string name) {
  FV_CHECK_LT(1u, series.size());
  MaxError worst;
  for (std::size_t i = 0; i + 1 < series.size(); ++i)
    worst.take(std::abs(series[i + 1].y - series[i].y),
               [&] { return fmt::format("after azimuth {:g}", series[i].x); });
  return worst.atMost(tolerance, std::move(name));
}

ReportSection turntableQuality(const StageMaker& make, const QualityScene& scene, int frames, int imageEdge) {
  std::vector<Camera> cameras = framingOrbit(scene.volume, 0.0, kTurntableElevation, 4 * frames, 1.0, {});
  cameras.resize(std::size_t(frames) + 1);
  const std::vector<Image> oracle = oracleImages(classifiedAfter(scene), cameras, glm::ivec2(imageEdge));
  ReportSection section{
      .title = fmt::format("Image quality: a quarter of a turn around {}", scene.name),
      .text = fmt::format("{} frames of {}x{} pixels at elevation {:g}, from one distance. Quality changes smoothly with the angle "
                          "between the line of sight and the axes; a step from one frame to the next would be seen as popping.",
                          cameras.size(), imageEdge, imageEdge, kTurntableElevation)};
  ReportPlot plot{.caption = "PSNR against the oracle",
                  .xLabel = "azimuth in degrees",
                  .yLabel = "PSNR in dB",
                  .series = {}};
  const std::vector<QualityMethod>& methods = qualityMethods();
  for (const QualityMethod& method : methods) {
    if (!method.goals.least && !method.frame.isSorted()) continue;
    ReportPlot::Series series{.name = method.name, .points = {}};
    for (const double psnr : turntablePsnr(make, scene, method, cameras, oracle))
      series.points.emplace_back(90.0 * double(series.points.size()) / frames, psnr);
    plot.series.push_back(std::move(series));
  }
  std::vector<glm::dvec2> errors = plot.series.front().points;
  for (glm::dvec2& point : errors) point.y = std::pow(10.0, -0.05 * point.y);
  section.checks.push_back(
      largestJump(errors, kMaxJump, fmt::format("{}: RMS error from one frame to the next", plot.series.front().name)));
  section.plots.push_back(std::move(plot));
  return section;
}

}  // namespace freevoxels
