#include "engine/validation/detail_quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/image/metrics.h"
#include "engine/renderer.h"
#include "engine/validation/max_error.h"

namespace freevoxels {

namespace {

constexpr double kMinPsnr = 35.0;  ///< in dB: engine/docs/validation.md, Bounds
/// A change between frames that all voxels show as well is not a step, nor is less than one code of an 8-bit
/// image in addition.
constexpr double kZoomMargin = 1.0 / 255.0;
constexpr int kZoomFrames = 60, kZoomImage = 64;
constexpr double kZoomNear = 2.0, kZoomFar = 0.125;  ///< in pixels per voxel
constexpr std::array<QualityView, 3> kViews{{{35, 25}, {200, 10}, {0, 0}}};

/// Width in pixels of a voxel in the middle of the volume.
double pixelsPerVoxel(const Volume& volume, const Camera& camera, int imageEdge) {
  const double height = 2.0 * std::tan(camera.verticalFov * std::numbers::pi / 360.0) *
                        glm::length(camera.lookAt - camera.position);
  return volume.voxelSize() / height * imageEdge;
}

Image image(Renderer& renderer, const Camera& camera, int edge, float lod) {
  return renderer.render(camera, {.size = glm::ivec2(edge), .method = SplatSettings{}, .lod = lod});
}

/// The size of the image that the volume fills.
Check checkAgainstVoxels(Renderer& renderer, const Volume& volume, double pixels, ReportTable& table) {
  Check worst{.name = fmt::format("level of detail 1: voxels of {:g} pixel", pixels),
              .figure = 1e9,
              .bound = Check::Bound::AtLeast,
              .tolerance = kMinPsnr,
              .unit = "dB"};
  std::vector<std::string> row{fmt::format("{:g} pixel", pixels)};
  for (const QualityView& view : kViews) {
    const Camera camera = viewCamera(volume, view);
    const int edge = std::max(int(std::lround(pixels / pixelsPerVoxel(volume, camera, 1))), 1);
    const double psnr = compareImages(image(renderer, camera, edge, 1.0f), image(renderer, camera, edge, 0.0f)).psnr;
    row.push_back(fmt::format("{:.1f}", psnr));
    if (psnr >= worst.figure) continue;
    worst.figure = psnr;
    worst.where = viewText(view);
  }
  table.rows.push_back(std::move(row));
  return worst;
}

/// The largest excess of the change from one frame to the next over that of all voxels.
Check checkZoom(Renderer& renderer, const Volume& volume, ReportPlot& plot) {
  Camera camera = viewCamera(volume, kViews[0]);
  const glm::dvec3 toEye = camera.position - camera.lookAt;
  const double framed = pixelsPerVoxel(volume, camera, kZoomImage);
  MaxError worst;
  std::array<Image, 2> last;
  plot.series = {{"level of detail 1", {}}, {"voxels", {}}};
  for (int frame = 0; frame < kZoomFrames; ++frame) {
    const double pixels = kZoomFar * std::pow(kZoomNear / kZoomFar, double(frame) / (kZoomFrames - 1));
    camera.position = camera.lookAt + framed / pixels * toEye;
    std::array<double, 2> change{};
    for (std::size_t i = 0; i < 2; ++i) {
      Image now = image(renderer, camera, kZoomImage, i == 0 ? 1.0f : 0.0f);
      if (frame > 0) {
        change[i] = compareImages(now, last[i]).rmse;
        plot.series[i].points.emplace_back(pixels, change[i]);
      }
      last[i] = std::move(now);
    }
    worst.take(change[0] - change[1], [&] { return fmt::format("{:.3g} pixels a voxel", pixels); });
  }
  return worst.atMost(kZoomMargin, "zoom of 60 frames: change from frame to frame beyond that of the voxels",
                      "RMSE");
}

}  // namespace

ReportSection detailQuality(const Device& device, const QualityScene& scene) {
  ReportSection section{.title = fmt::format("Level of detail: {}", scene.name),
                        .text = "Images at level of detail 1 against those of all voxels."};
  Renderer renderer(device, scene.volume, scene.classification, {});
  ReportTable table{.caption = "PSNR in dB", .columns = {"voxels"}, .rows = {}};
  for (const QualityView& view : kViews) table.columns.push_back(viewText(view));
  for (const double pixels : {0.5, 0.25, 0.125})
    section.checks.push_back(checkAgainstVoxels(renderer, scene.volume, pixels, table));
  section.tables.push_back(std::move(table));
  return section;
}

ReportSection zoomQuality(const Device& device, const QualityScene& scene) {
  ReportSection section{
      .title = fmt::format("Zoom: {}", scene.name),
      .text = "What changes from frame to frame at level of detail 1, and with all voxels."};
  Renderer renderer(device, scene.volume, scene.classification, {});
  ReportPlot plot{.caption = fmt::format("A zoom of {} frames", kZoomFrames),
                  .xLabel = "pixels a voxel",
                  .yLabel = "RMSE",
                  .series = {}};
  section.checks.push_back(checkZoom(renderer, scene.volume, plot));
  section.plots.push_back(std::move(plot));
  return section;
}

}  // namespace freevoxels
