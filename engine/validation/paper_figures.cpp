#include "engine/validation/paper_figures.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "engine/image/metrics.h"
#include "engine/reference/oracle.h"
#include "engine/scene/directions.h"
#include "engine/validation/equal_voxels.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/validation/lattice_steps.h"
#include "engine/validation/light_checks.h"
#include "engine/validation/max_error.h"
#include "engine/validation/quality_scenes.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

namespace {

/// Figure 2: a cube of optical depth 3.5 from face to face.
constexpr int kTableCubeEdge = 32;
const glm::ivec2 kTableImage(256);
/// A camera that sees the sides +y and +z, which the directions point to, and -x, which they come from.
constexpr QualityView kTableView{-35, 25};
constexpr double kTableCubeExtinction = 3.5;
/// Opaque enough to show the surface, without hard edges.
constexpr float kShownOpacity = 0.5f;
/// A background that is not grey, so that black and white voxels are both visible.
const glm::vec3 kShownBackground(0.08f, 0.16f, 0.3f);
/// Half a code of depth8 is worth at most 4 sqrt(tau) exp(-tau) / 255, largest at tau = 1/2.
constexpr double kHalfCodeTransmittance = 0.007;

/// Figure 6: the fewer voxels, the larger their pattern.
constexpr int kLeakingCubeEdge = 8;
const glm::ivec2 kLeakingImage(128);
constexpr double kLeakingCubeExtinction = 4.0;
constexpr std::array<QualityView, 2> kLeakingViews{{{0, 0}, {35, 25}}};

/// Figure 7: a head in soft tissue, the light beside and above; and a smaller one for the oracle, whose
/// shadow rays take their time.
constexpr int kLitHeadEdge = 64, kJudgedHeadEdge = 32;
const glm::ivec2 kLitImage(192), kJudgedImage(48);
constexpr QualityView kLitView{30, 8};
const glm::dvec3 kToLight(-1.0, 0.8, 0.35), kRed(1.0, 0.12, 0.06);
constexpr double kLitIntensity = 2.0 * kDefaultIrradiance;
/// As in flesh, red light travels far and blue light does not.
const glm::dvec3 kFleshTint(0.3, 1.0, 1.6);
constexpr double kMinBleeding = 1.2;

/// A volume whose scalars are the transmittances along a direction, from the table.
Volume transmittances(const Volume& cube, const std::vector<std::uint8_t>& plane) {
  return makeVolume(cube.dimensions, cube.indexToWorld, [&](int x, int y, int z) {
    return std::exp(-decodeOpticalDepth(AttenuationCode::Depth8, plane[cube.at(x, y, z)]));
  });
}

/// A transfer function from black for 0 to white for 1.
Classification asBrightness(const Volume& volume) {
  Classification classification;
  classification.transferFunction =
      TransferFunction{.opacity = {{0.0f, kShownOpacity}},
                       .color = {{0.0f, glm::vec3(0.0f)}, {1.0f, glm::vec3(1.0f)}},
                       .unitDistance = volume.voxelSize()};
  return classification;
}

Check checkTransmittances(const Volume& shown, int direction) {
  const glm::ivec3 d = latticeStep(direction), size = shown.dimensions;
  const double step = stepLength(shown.indexToWorld, d, true);
  MaxError worst;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const double depth = kTableCubeExtinction * voxelsAhead({x, y, z}, d, size) * step;
        worst.take(std::abs(double(shown.scalar(x, y, z)) - std::exp(-depth)),
                   [&] { return voxelText(shown, shown.at(x, y, z)); });
      }
  return worst.atMost(kHalfCodeTransmittance, fmt::format("figure 2: transmittance is exp(-sigma n |d|), {}",
                                                          directionText(kLatticeSteps, direction)));
}

double meanAlphaError(const Image& image, const Image& oracle) {
  double sum = 0.0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) sum += std::abs(double(image.pixels[i].a) - double(oracle.pixels[i].a));
  return sum / double(image.pixels.size());
}

void addLeakingView(const StageMaker& make, const Volume& cube, const QualityView& view,
                    ReportSection& section, ReportTable& table) {
  const Classification classification = physical(kLeakingCubeExtinction, glm::vec3(0.0f));
  const Camera camera = viewCamera(cube, view);
  const auto outputs = make(cube, classification, {});
  const Image oracle = renderOracle(cube, classification, camera, {.size = kLeakingImage}).image;
  const auto draw = [&](Composite composite) {
    return outputs->image(camera, {.size = kLeakingImage, .method = SplatSettings{.composite = composite}});
  };
  const Image sorted = draw(Composite::Sorted), additive = draw(Composite::Additive),
              normalised = draw(Composite::Normalised);
  const double sortedError = meanAlphaError(sorted, oracle);
  section.checks.push_back(
      {.name = "figure 6: error of FreeVoxels' alpha over that of sorted blending, from " + viewText(view),
       .figure = meanAlphaError(normalised, oracle) / sortedError,
       .bound = Check::Bound::AtMost,
       .tolerance = 1.0,
       .unit = "",
       .where = ""});
  table.rows.push_back({viewText(view), fmt::format("{:.4f}", sortedError),
                        fmt::format("{:.4f}", meanAlphaError(additive, oracle)),
                        fmt::format("{:.4f}", meanAlphaError(normalised, oracle))});
  section.imageRows.push_back({.caption = "From " + viewText(view),
                               .images = {{"sorted, back to front: leaks", sorted},
                                          {"FreeVoxels, additive", additive},
                                          {"FreeVoxels, normalised", normalised},
                                          {"oracle", oracle}},
                               .background = glm::vec3(1.0f)});
}

struct LitHead {
  Volume volume;
  Classification classification;
  std::unique_ptr<StageOutputs> outputs;

  LitHead(const StageMaker& make, int edge) : volume(makeProcedural("head", edge)) {
    classification.transferFunction = qualityTransferFunction(QualityColor::Bone, volume);
    classification.order = ClassificationOrder::Pre;  // as splats use it
    outputs = make(volume, classification, {});
  }
  Camera camera() const { return viewCamera(volume, kLitView); }
  Image image(glm::ivec2 size, const std::optional<Lighting>& lighting) const {
    return outputs->image(camera(), {.size = size, .method = SplatSettings{}, .lighting = lighting});
  }
};

Check checkLitHead(const LitHead& head, const Lighting& lighting) {
  const OracleSettings truth{.size = kJudgedImage, .tolerance = 4e-3, .lighting = lighting};
  const Image oracle = renderOracle(head.volume, head.classification, head.camera(), truth).image;
  return {.name = fmt::format("figure 7: red light, {}^3", kJudgedHeadEdge),
          .figure = compareImages(head.image(kJudgedImage, lighting), oracle).psnr,
          .bound = Check::Bound::AtLeast,
          .tolerance = kTableLightPsnr,
          .unit = "dB",
          .where = viewText(kLitView)};
}

/// The mean opacity of the image.
double redOverBlue(const Image& image) {
  glm::dvec4 sum(0.0);
  for (const glm::vec4& pixel : image.pixels) sum += glm::dvec4(pixel);
  return sum.r / sum.b;
}

}  // namespace

ReportSection paperFigure2(const StageMaker& make) {
  const Volume cube =
      constantVolume(glm::ivec3(kTableCubeEdge), cubeTransform(glm::ivec3(kTableCubeEdge)), 1.0);
  const TableBytes table = make(cube, physical(kTableCubeExtinction, glm::vec3(1.0f)), {})->table();
  ReportSection section{
      .title = "Subr et al. 2007, figure 2: the attenuation table of a uniform translucent cube",
      .text =
          "Each voxel is as bright as the transmittance from it to the outside along a direction d, as the "
          "table has it (Eq. 5): white where the way is free, darker the more of the cube is in the way."};
  ImageRow row{.caption = "Seen from azimuth -35, elevation 25: +x points to the upper right, +y up, +z to the lower right",
               .images = {},
               .background = kShownBackground};
  for (const int direction :
       {directionIndex(kLatticeSteps, {1, 0, 0}), directionIndex(kLatticeSteps, {1, 1, 0}),
        directionIndex(kLatticeSteps, {1, 1, 1})}) {
    const Volume shown = transmittances(cube, table[std::size_t(direction)]);
    section.checks.push_back(checkTransmittances(shown, direction));
    const auto outputs = make(shown, asBrightness(shown), {});
    row.images.push_back({directionText(kLatticeSteps, direction),
                          outputs->image(viewCamera(shown, kTableView), {.size = kTableImage, .method = SplatSettings{}})});
  }
  section.imageRows.push_back(std::move(row));
  return section;
}

ReportSection paperFigure6(const StageMaker& make) {
  const glm::ivec3 size(kLeakingCubeEdge);
  const Volume cube = constantVolume(size, cubeTransform(size), 1.0);
  ReportSection section{
      .title = "Subr et al. 2007, figure 6: attenuation leakage",
      .text =
          "A uniform translucent cube of 8 voxels along an edge that absorbs and does not shine, before a "
          "white background: what is seen is the light that comes through. Blended back to front, splats "
          "that share a layer each attenuate by themselves (Eq. 9): too much comes through, and the voxels "
          "show. FreeVoxels add up without an order; the additive sum (Eq. 10) is uneven and in parts "
          "passes 1, which is black here; normalised, it is near the oracle."};
  ReportTable table{.caption = "Mean absolute error of alpha against the oracle",
                    .columns = {"view", "sorted", "FreeVoxels, additive", "FreeVoxels, normalised"},
                    .rows = {}};
  for (const QualityView& view : kLeakingViews) addLeakingView(make, cube, view, section, table);
  section.tables.push_back(std::move(table));
  return section;
}

ReportSection paperFigure7(const StageMaker& make) {
  const LitHead shown(make, kLitHeadEdge), judged(make, kJudgedHeadEdge);
  ReportSection section{.title = "Subr et al. 2007, figure 7: a head in red light",
                        .text =
                            "Every voxel looks up its transmittance to the light in the table that it has "
                            "for the eye (Section 4.3): "
                            "shadows in one pass. Where each colour has an extinction of its own on the way "
                            "of the light, white light "
                            "turns red in flesh."};
  const Lighting white{.lights = {{.place = kToLight, .intensity = kLitIntensity}},
                       .attenuation = LightAttenuation::Table};
  Lighting red = white, turning = white;
  red.lights.front().color = kRed;
  turning.tint = kFleshTint;
  const Image turned = shown.image(kLitImage, turning);
  section.imageRows.push_back({.caption = "From " + viewText(kLitView),
                               .images = {{"without light", shown.image(kLitImage, std::nullopt)},
                                          {"red light", shown.image(kLitImage, red)},
                                          {"white light that turns red", turned}},
                               .background = glm::vec3(0.0f)});
  section.checks = {checkLitHead(judged, red),
                    {.name = "figure 7: red over blue, of white light that turns red against that which does not",
                     .figure = redOverBlue(turned) / redOverBlue(shown.image(kLitImage, white)),
                     .bound = Check::Bound::AtLeast,
                     .tolerance = kMinBleeding,
                     .unit = "",
                     .where = ""}};
  return section;
}

}  // namespace freevoxels
