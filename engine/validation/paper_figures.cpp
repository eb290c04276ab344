#include "engine/validation/paper_figures.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/attenuation/directions.h"
#include "engine/reference/oracle.h"
#include "engine/validation/equal_voxels.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/validation/worst.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

namespace {

const glm::ivec2 kPictureSize(256);

/// Figure 2: a cube of optical depth 3.5 from face to face.
constexpr int kTableCubeEdge = 32;
constexpr double kTableCubeExtinction = 3.5;
/// Opaque enough for the surface to be seen, not for the edges to be hard.
constexpr float kShownOpacity = 0.5f;
/// No grey, so that both black and white voxels stand out.
const glm::vec3 kShownBackground(0.08f, 0.16f, 0.3f);
/// Half a code of depth8 is worth at most 4 sqrt(tau) exp(-tau) / 255, largest at tau = 1/2.
constexpr double kHalfCodeTransmittance = 0.007;

/// Figure 6: the fewer voxels, the larger their pattern.
constexpr int kLeakingCubeEdge = 8;
constexpr double kLeakingCubeExtinction = 4.0;

Camera obliqueCamera(const Volume& volume) {
  return framingCamera(volume, 35.0, 25.0, 1.0, {});
}

/// Scalars are transmittances along a direction, out of the table.
Volume transmittances(const Volume& cube, const std::vector<std::uint8_t>& plane) {
  return makeVolume(cube.dimensions, cube.indexToWorld, [&](int x, int y, int z) {
    return std::exp(-decodeOpticalDepth(AttenuationCode::Depth8, plane[cube.at(x, y, z)]));
  });
}

/// Scalar 0 is black, 1 is white.
Classification asBrightness(const Volume& volume) {
  Classification classification;
  classification.transferFunction =
      TransferFunction{.opacity = {{0.0f, kShownOpacity}},
                       .color = {{0.0f, glm::vec3(0.0f)}, {1.0f, glm::vec3(1.0f)}},
                       .unitDistance = volume.voxelSize()};
  return classification;
}

Check checkTransmittances(const Volume& shown, int direction) {
  const glm::ivec3 d = directionAt(direction), size = shown.dimensions;
  const double step = stepLength(shown.indexToWorld, d, true);
  Worst worst;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const double depth = kTableCubeExtinction * voxelsAhead({x, y, z}, d, size) * step;
        const std::size_t voxel = shown.at(x, y, z);
        worst.take(std::abs(double(shown.values[voxel]) - std::exp(-depth)),
                   [&] { return voxelText(shown, voxel); });
      }
  return worst.atMost(kHalfCodeTransmittance, fmt::format("figure 2: transmittance is exp(-sigma n |d|), {}",
                                                          directionText(direction)));
}

double meanAlphaError(const Image& picture, const Image& oracle) {
  double sum = 0.0;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    sum += std::abs(double(picture.pixels[i].a) - double(oracle.pixels[i].a));
  return sum / double(picture.pixels.size());
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
  ReportPictures pictures{.caption =
                              "Seen from azimuth 35, elevation 25: +x points to the lower right, +y up, +z "
                              "to the lower left",
                          .pictures = {},
                          .background = kShownBackground};
  for (const int direction : {directionIndex(1, 0, 0), directionIndex(1, 1, 0), directionIndex(1, 1, 1)}) {
    const Volume shown = transmittances(cube, table[std::size_t(direction)]);
    section.checks.push_back(checkTransmittances(shown, direction));
    const auto outputs = make(shown, asBrightness(shown), {});
    pictures.pictures.push_back(
        {directionText(direction), outputs->picture(obliqueCamera(shown), {.size = kPictureSize})});
  }
  section.pictures.push_back(std::move(pictures));
  return section;
}

ReportSection paperFigure6(const StageMaker& make) {
  const glm::ivec3 size(kLeakingCubeEdge);
  const Volume cube = constantVolume(size, cubeTransform(size), 1.0);
  const Classification classification = physical(kLeakingCubeExtinction, glm::vec3(0.8f));
  const Camera camera = obliqueCamera(cube);
  const auto outputs = make(cube, classification, {});
  const Image oracle = renderOracle(cube, classification, camera, {.size = kPictureSize}).image;
  const Image sorted = outputs->picture(camera, {.size = kPictureSize, .composite = Composite::Sorted});
  const Image free = outputs->picture(camera, {.size = kPictureSize});
  const double sortedError = meanAlphaError(sorted, oracle), freeError = meanAlphaError(free, oracle);
  return {
      .title = "Subr et al. 2007, figure 6: attenuation leakage",
      .text =
          "A uniform translucent cube of 8 voxels along an edge. Blended back to front, splats that share "
          "a layer each attenuate what is behind by themselves (Eq. 9): the cube is too transparent and "
          "its voxels show. FreeVoxels add up without an order, here with the normalised composite.",
      .checks = {{.name = "figure 6: mean error of FreeVoxels' alpha over that of sorted blending",
                  .figure = freeError / sortedError,
                  .bound = Check::Bound::AtMost,
                  .tolerance = 1.0,
                  .unit = "",
                  .where = ""}},
      .tables = {{.caption = "Mean absolute error of alpha against the oracle",
                  .columns = {"method", "error"},
                  .rows = {{"sorted", fmt::format("{:.4f}", sortedError)},
                           {"FreeVoxels", fmt::format("{:.4f}", freeError)}}}},
      .plots = {},
      .pictures = {{.caption = "As figure 6, and the oracle",
                    .pictures = {{"sorted, back to front: leaks", sorted},
                                 {"FreeVoxels, in any order", free},
                                 {"oracle", oracle}},
                    .background = {}}}};
}

}  // namespace freevoxels
