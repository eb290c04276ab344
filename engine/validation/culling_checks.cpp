#include "engine/validation/culling_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "engine/image/metrics.h"
#include "engine/renderer.h"
#include "engine/validation/max_error.h"
#include "engine/validation/quality_images.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

struct NamedView {
  std::string name;
  Camera camera;
};

std::vector<NamedView> viewsOf(const Volume& volume) {
  std::vector<NamedView> views;
  for (const QualityView& view : quickQualityViews())
    views.push_back({viewText(view), viewCamera(volume, view)});
  views.push_back({"orthographic", framingCamera(volume, 200.0, 10.0, 1.0, {.orthographic = true})});
  NamedView part{"a small part", viewCamera(volume, {})};
  part.camera.verticalFov /= 8.0;
  views.push_back(part);
  NamedView inside{"from inside", viewCamera(volume, {.azimuth = 110.0, .elevation = -35.0})};
  inside.camera.position = inside.camera.lookAt + 0.1 * (inside.camera.position - inside.camera.lookAt);
  views.push_back(inside);
  return views;
}

std::vector<std::string> countsRow(const std::string& name, const CutCounts& counts, std::uint64_t voxels) {
  const std::uint64_t drawn = std::accumulate(counts.drawn.begin(), counts.drawn.end(), std::uint64_t(0));
  std::vector<std::string> row{name};
  for (const std::uint64_t count :
       {counts.considered, counts.empty, counts.outside, counts.hidden, counts.opened, drawn})
    row.push_back(fmt::format("{}", count));
  row.push_back(fmt::format("{:.1f} %", 100.0 * double(drawn) / double(voxels)));
  return row;
}

}  // namespace

ReportSection cullingChecks(const Device& device, const QualityScene& scene, int imageEdge) {
  ReportSection section{.title = fmt::format("Culling: {}", scene.name),
                        .text = "Images without what is outside of them or hidden, against images of everything."};
  Renderer renderer(device, scene.volume, scene.classification, {});
  const FrameSettings culled{.size = glm::ivec2(imageEdge), .method = SplatSettings{.composite = Composite::Additive}, .lod = 0.0f};
  FrameSettings whole = culled, clipped = culled;
  whole.splats().culling = false;
  clipped.splats().cullThreshold = 0.0f;
  ReportTable table{
      .caption = "Blocks of all levels",
      .columns = {"view", "considered", "empty", "outside", "hidden", "opened", "drawn", "of all voxels"},
      .rows = {}};
  MaxError worst, worstClipped;
  double leastPsnr = 1e9;
  std::string leastAt;
  for (const NamedView& view : viewsOf(scene.volume)) {
    const Image expected = renderer.render(view.camera, whole);
    const Image inImage = renderer.render(view.camera, clipped);
    worstClipped.take(largestDifference(inImage, expected).figure(), [&] { return view.name; });
    const Image image = renderer.render(view.camera, culled);
    table.rows.push_back(countsRow(view.name, renderer.cutCounts(), *renderer.occupiedVoxelCount()));
    const double psnr = std::min(compareImages(image, expected).psnr, 200.0);
    if (psnr < leastPsnr) {
      leastPsnr = psnr;
      leastAt = view.name;
    }
    worst.take(largestDifference(image, expected).figure(), [&] {
      section.imageRows = {{.caption = fmt::format("Where they differ most: {}", view.name),
                            .images = {{"everything", expected},
                                       {"culled", image},
                                       {fmt::format("{:g} times the difference", kDifferenceGain), visibleDifference(image, expected)}}}};
      return view.name;
    });
  }
  section.checks = {
      worst.atMost(kCullingDifference, "culled against everything: largest difference"),
      {.name = "culled against everything",
       .figure = leastPsnr,
       .bound = Check::Bound::AtLeast,
       .tolerance = kCullingPsnr,
       .unit = "dB",
       .where = leastAt},
      worstClipped.atMost(kFrustumDifference, "without what is outside of the image: largest difference")};
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace freevoxels
