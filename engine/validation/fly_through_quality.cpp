#include "engine/validation/fly_through_quality.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/image/metrics.h"
#include "engine/validation/fly_through.h"
#include "engine/validation/max_error.h"
#include "engine/validation/quality_images.h"

namespace freevoxels {

namespace {

constexpr double kMinPsnr = 40.0;  ///< in dB, for every frame: engine/docs/validation.md, Bounds
constexpr double kMaxWrongChange =
    0.015;  ///< twice the error at 42 dB; a layer of voxels that pops makes 0.05
constexpr int kShownFrames = 6;

std::vector<QualityMethod> methods() {
  const QualityMethod splats{.name = "splats", .table = {}, .frame = {.method = SplatSettings{}}, .goals = {}};
  const std::vector<QualityMethod>& all = qualityMethods();
  QualityMethod first = all.front();
  first.order = ClassificationOrder::Pre;  // far away both classifications use blocks that are classified before interpolation
  return {first, splats, all[sortedMethod(all)]};
}

ReportPlot::Series psnrSeries(const std::string& name, const std::vector<Image>& images, const std::vector<Image>& oracle) {
  ReportPlot::Series series{.name = name, .points = {}};
  for (std::size_t i = 0; i < images.size(); ++i) series.points.emplace_back(double(i), compareImages(images[i], oracle[i]).psnr);
  return series;
}

Check leastPsnr(const ReportPlot::Series& series) {
  glm::dvec2 worst = series.points.front();
  for (const glm::dvec2 point : series.points)
    if (!(point.y >= worst.y)) worst = point;
  return {.name = fmt::format("{}: least PSNR of any frame", series.name),
          .figure = worst.y,
          .bound = Check::Bound::AtLeast,
          .tolerance = kMinPsnr,
          .unit = "dB",
          .where = fmt::format("frame {:g}", worst.x)};
}

/// How much the images change from one frame to the next, and how much of that is an error.
ReportPlot changePlot(const std::vector<Image>& images, const std::vector<Image>& oracle) {
  ReportPlot plot{
      .caption = "Change since the frame before",
      .xLabel = "frame",
      .yLabel = "RMSE",
      .series = {{.name = "image", .points = {}}, {.name = "oracle", .points = {}}, {.name = "what is wrong of it", .points = {}}}};
  for (std::size_t i = 1; i < images.size(); ++i) {
    const auto add = [&](std::size_t series, double y) {
      plot.series[series].points.emplace_back(double(i), y);
    };
    add(0, compareImages(images[i], images[i - 1]).rmse);
    add(1, compareImages(oracle[i], oracle[i - 1]).rmse);
    add(2, wrongChange(images[i - 1], images[i], oracle[i - 1], oracle[i]));
  }
  return plot;
}

Check mostWrongChange(const ReportPlot::Series& wrong, const std::string& method) {
  MaxError worst;
  for (const glm::dvec2 point : wrong.points)
    worst.take(point.y, [&] { return fmt::format("frame {:g}", point.x); });
  return worst.atMost(kMaxWrongChange, method + ": change from frame to frame that is not the oracle's",
                      "RMSE");
}

ImageRow someFrames(const std::string& method, const std::vector<Image>& images, const std::vector<Image>& oracle) {
  ImageRow shown{.caption = fmt::format("Frames of \"{}\", each before the oracle's", method), .images = {}};
  for (std::size_t i = 0; i < kShownFrames; ++i) {
    const std::size_t frame = i * (images.size() - 1) / (kShownFrames - 1);
    shown.images.push_back({fmt::format("frame {}", frame), images[frame]});
    shown.images.push_back({"oracle", oracle[frame]});
  }
  return shown;
}

}  // namespace

double wrongChange(const Image& before, const Image& after, const Image& trueBefore, const Image& trueAfter) {
  FV_CHECK_EQ(before.pixels.size(), trueBefore.pixels.size());
  FV_CHECK_EQ(after.pixels.size(), trueAfter.pixels.size());
  FV_CHECK_EQ(before.pixels.size(), after.pixels.size());
  double squares = 0.0;
  for (std::size_t i = 0; i < after.pixels.size(); ++i) {
    const glm::dvec4 change = glm::dvec4(after.pixels[i]) - glm::dvec4(before.pixels[i]);
    const glm::dvec4 wrong = change - (glm::dvec4(trueAfter.pixels[i]) - glm::dvec4(trueBefore.pixels[i]));
    squares += glm::dot(wrong, wrong);
  }
  return std::sqrt(squares / (4.0 * double(after.pixels.size())));
}

ReportSection flyThroughQuality(const StageMaker& make, const QualityScene& scene, int frames, int imageEdge) {
  const std::vector<Camera> cameras = flyThrough(scene.volume, frames);
  const glm::ivec2 size(imageEdge);
  const std::vector<Image> oracle = oracleImages(scene, cameras, size);
  ReportSection section{.title = fmt::format("Image quality: a flight through {}", scene.name),
                        .text = fmt::format("{} frames of {}x{} pixels, from outside to the centre and out again, the view turning on "
                                            "the way. What of the change from one frame to the next is not the oracle's would be seen "
                                            "as popping.",
                                            frames, imageEdge, imageEdge)};
  ReportPlot psnr{
      .caption = "PSNR against the oracle", .xLabel = "frame", .yLabel = "PSNR in dB", .series = {}};
  for (const QualityMethod& method : methods()) {
    const std::vector<Image> images = methodImages(make, scene, method, cameras, size);
    psnr.series.push_back(psnrSeries(method.name, images, oracle));
    if (psnr.series.size() > 1) continue;
    section.plots.push_back(changePlot(images, oracle));
    section.checks = {leastPsnr(psnr.series.front()),
                      mostWrongChange(section.plots.front().series.back(), method.name)};
    section.imageRows.push_back(someFrames(method.name, images, oracle));
  }
  section.plots.insert(section.plots.begin(), std::move(psnr));
  return section;
}

}  // namespace freevoxels
