#include "engine/validation/quality_figures.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/image/flip.h"
#include "engine/image/metrics.h"

namespace freevoxels {

namespace {

template <typename Value>
double meanOf(const std::vector<ImageFigures>& figures, Value value) {
  double sum = 0.0;
  for (const ImageFigures& figure : figures) sum += value(figure);
  return sum / double(figures.size());
}

Check leastPsnr(const QualityFigures& scene, std::size_t method, const std::string& name, double least) {
  const std::size_t worst = scene.worstView(method);
  return {.name = fmt::format("{}: least PSNR of any view", name),
          .figure = scene.figures[method][worst].psnr,
          .bound = Check::Bound::AtLeast,
          .tolerance = least,
          .unit = "dB",
          .where = viewText(scene.views[worst])};
}

Check againstSorted(const QualityFigures& scene, std::size_t method, const std::string& name,
                    std::size_t sorted) {
  const auto gain = [&](std::size_t view) {
    const double own = scene.figures[method][view].psnr, other = scene.figures[sorted][view].psnr;
    return own == other ? 0.0 : own - other;  // both may be infinite
  };
  std::size_t worst = 0;
  for (std::size_t view = 1; view < scene.views.size(); ++view)
    if (gain(view) < gain(worst)) worst = view;
  return {.name = fmt::format("{}: PSNR above that of sorted blending, any view", name),
          .figure = gain(worst),
          .bound = Check::Bound::AtLeast,
          .tolerance = 0.0,
          .unit = "dB",
          .where = viewText(scene.views[worst])};
}

/// "31.2–44.7"
std::string rangeText(const std::vector<ImageFigures>& figures) {
  const auto [least, largest] = std::ranges::minmax(figures, {}, &ImageFigures::psnr);
  return fmt::format("{:.1f}–{:.1f}", least.psnr, largest.psnr);
}

/// The mean over all views of all scenes that count.
double meanPsnr(const std::vector<QualityFigures>& scenes, std::size_t method, bool onlyWithGoals) {
  std::vector<ImageFigures> all;
  for (const QualityFigures& scene : scenes)
    if (scene.hasGoals || !onlyWithGoals)
      all.insert(all.end(), scene.figures[method].begin(), scene.figures[method].end());
  return meanOf(all, [](const ImageFigures& figure) { return figure.psnr; });
}

ReportTable summaryTable(const std::vector<QualityFigures>& scenes,
                         const std::vector<QualityMethod>& methods) {
  ReportTable table{.caption = "PSNR in dB against the oracle: the range over the views",
                    .columns = {"method"},
                    .rows = {}};
  for (const QualityFigures& scene : scenes) table.columns.push_back(scene.scene);
  table.columns.push_back("mean");
  for (std::size_t method = 0; method < methods.size(); ++method) {
    std::vector<std::string> row{methods[method].name};
    for (const QualityFigures& scene : scenes) row.push_back(rangeText(scene.figures[method]));
    row.push_back(fmt::format("{:.1f}", meanPsnr(scenes, method, false)));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

ImageFigures compareToOracle(const Image& image, const Image& oracle) {
  const glm::vec3 grey(kFlipBackground);
  const Image test = compositeOver(image, grey), reference = compositeOver(oracle, grey);
  return {.psnr = compareImages(image, oracle).psnr, .flip = hdrFlip(test, reference, flipExposures(reference)).mean()};
}

double QualityFigures::meanPsnr(std::size_t method) const {
  return meanOf(figures[method], [](const ImageFigures& figure) { return figure.psnr; });
}

double QualityFigures::meanFlip(std::size_t method) const {
  return meanOf(figures[method], [](const ImageFigures& figure) { return figure.flip; });
}

std::size_t QualityFigures::worstView(std::size_t method) const {
  const auto worst = std::ranges::min_element(figures[method], {}, &ImageFigures::psnr);
  return std::size_t(worst - figures[method].begin());
}

ReportTable methodTable(const QualityFigures& scene, const std::vector<QualityMethod>& methods) {
  ReportTable table{.caption = fmt::format("{}: PSNR in dB over the {} views, and mean HDR-FLIP", scene.scene,
                                           scene.views.size()),
                    .columns = {"method", "mean", "least", "least at", "HDR-FLIP"},
                    .rows = {}};
  for (std::size_t method = 0; method < methods.size(); ++method) {
    const std::size_t worst = scene.worstView(method);
    table.rows.push_back({methods[method].name, fmt::format("{:.1f}", scene.meanPsnr(method)),
                          fmt::format("{:.1f}", scene.figures[method][worst].psnr),
                          viewText(scene.views[worst]), fmt::format("{:.4f}", scene.meanFlip(method))});
  }
  return table;
}

ReportTable viewTable(const QualityFigures& scene, const std::vector<QualityMethod>& methods) {
  ReportTable table{.caption = fmt::format("{}: PSNR in dB by view (azimuth, elevation)", scene.scene),
                    .columns = {"view"},
                    .rows = {}};
  for (const QualityMethod& method : methods) table.columns.push_back(method.name);
  for (std::size_t view = 0; view < scene.views.size(); ++view) {
    std::vector<std::string> row{viewText(scene.views[view])};
    for (const auto& figures : scene.figures) row.push_back(fmt::format("{:.1f}", figures[view].psnr));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<Check> sceneChecks(const QualityFigures& scene, const std::vector<QualityMethod>& methods) {
  std::vector<Check> checks;
  if (!scene.hasGoals) return checks;
  for (std::size_t method = 0; method < methods.size(); ++method) {
    const auto& [name, table, frame, order, goals] = methods[method];
    const auto least = scene.thin ? goals.leastThin : goals.least;
    if (least && !(scene.thin && scene.resolution > goals.thinResolution))
      checks.push_back(leastPsnr(scene, method, name, *least));
    if (goals.notBelowSorted) checks.push_back(againstSorted(scene, method, name, sortedMethod(methods)));
  }
  return checks;
}

ReportSection summariseQuality(const std::vector<QualityFigures>& scenes,
                               const std::vector<QualityMethod>& methods) {
  ReportSection section{.title = "Image quality: summary",
                        .text = "All methods on all volumes. The last column is the mean over all views of all volumes."};
  if (std::ranges::any_of(scenes, &QualityFigures::hasGoals))
    for (std::size_t method = 0; method < methods.size(); ++method)
      if (methods[method].goals.mean)
        section.checks.push_back(
            {.name = fmt::format("{}: mean PSNR over all views of all volumes", methods[method].name),
             .figure = meanPsnr(scenes, method, true),
             .bound = Check::Bound::AtLeast,
             .tolerance = *methods[method].goals.mean,
             .unit = "dB",
             .where = ""});
  section.tables.push_back(summaryTable(scenes, methods));
  return section;
}

}  // namespace freevoxels
