#include "engine/validation/closed_forms.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "engine/validation/equal_voxels.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/validation/lattice_steps.h"
#include "engine/validation/max_error.h"
#include "engine/volume/procedural.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

constexpr double kInsideTolerance = 2e-3;    ///< for a homogeneous cube, whose footprints ripple by 0.3 %
constexpr double kRippleTolerance = 3e-3;    ///< for a full layer of footprints (footprint.h)
constexpr double kRoundingTolerance = 1e-5;  ///< for a few splats in 32-bit floats
constexpr double kIntegralTolerance = 1e-4;  ///< for 300² pixels

/// Eq. 5 for a homogeneous box: sigma times the number of steps ahead times their length.
Check checkTable(const StageMaker& make, AttenuationCode code) {
  const glm::ivec3 size(25, 19, 14);
  const double sigma = 3.0;
  const Volume volume = constantVolume(size, shearedTransform(size), sigma);
  const TableBytes table = make(volume, physical(1.0, glm::vec3(1.0f)), {.code = code})->table();
  MaxError worst;
  for (int d = 0; d < kLatticeStepCount; ++d) {
    const double step = stepLength(volume.indexToWorld, latticeStep(d), true);
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
          const std::size_t voxel = volume.at(x, y, z);
          const int steps = voxelsAhead({x, y, z}, latticeStep(d), size);
          const int expected = encodeOpticalDepth(code, sigma * steps * step);
          worst.take(std::abs(table[std::size_t(d)][voxel] - expected), [&] {
            return fmt::format("{}, {}", directionText(kLatticeSteps, d), voxelText(volume, voxel));
          });
        }
  }
  return worst.atMost(1.0,
                      fmt::format("Beer-Lambert in all 26 directions, {}",
                                  code == AttenuationCode::Depth8 ? "depth8" : "linear8"),
                      "codes");
}

struct ViewAngles {
  double azimuth, elevation;
  bool orthographic;
};
constexpr std::array<ViewAngles, 4> kCubeViews{{{35, 25, false}, {0, 0, false}, {-160, -50, true}, {45, 35.26, true}}};

/// The cube's bounding sphere fits the image.
Camera cameraOf(const Volume& cube, const ViewAngles& view) {
  Camera camera = framingCamera(cube, view.azimuth, view.elevation, 1.0, {});
  camera.position = 3.0 * glm::normalize(camera.position);
  camera.orthographic = view.orthographic;
  camera.orthographicHeight = 1.8;
  return camera;
}

void checkCube(const StageMaker& make, int edge, ReportSection& section) {
  const double sigma = 2.5;
  const glm::vec3 color(0.8f, 0.5f, 0.2f);
  const glm::ivec2 size(3 * edge);
  const Volume cube = constantVolume(glm::ivec3(edge), cubeTransform(glm::ivec3(edge)), 1.0);
  const auto device = make(cube, physical(sigma, color), {});
  ImageRow row{.caption = "A homogeneous cube: the device's images", .images = {}};
  for (const ViewAngles& view : kCubeViews) {
    const Camera camera = cameraOf(cube, view);
    const BoxImage box = boxImage(cube, sigma, color, camera, size);
    const Image image = device->image(camera, {.size = size, .method = SplatSettings{}});
    MaxError worst;
    for (std::size_t i = 0; i < box.interior.size(); ++i)
      for (int c = 0; c < 4 && box.interior[i]; ++c)
        worst.take(std::abs(double(image.pixels[i][c]) - double(box.image.pixels[i][c])), [&] { return pixelText(size, i); });
    const std::string name = fmt::format("from {}, {} {}", view.azimuth, view.elevation,
                                         view.orthographic ? "orthographic" : "perspective");
    section.checks.push_back(
        worst.atMost(kInsideTolerance, fmt::format("homogeneous cube away from its edges, {}", name)));
    row.images.push_back({name, image});
  }
  section.imageRows.push_back(std::move(row));
}

/// The depths of all pixels add up to sigma times the voxel's volume.
Check checkSingleVoxel(const StageMaker& make) {
  const double sigma = 0.7;
  const glm::ivec2 size(300);
  const Volume voxel = constantVolume(glm::ivec3(1), shearedTransform(glm::ivec3(1)), 1.0);
  const auto device = make(voxel, physical(sigma, glm::vec3(1.0f)), {});
  const double expected = sigma * std::abs(glm::determinant(glm::dmat3(voxel.indexToWorld)));
  MaxError worst;
  for (const double azimuth : {0.0, 40.0, -120.0}) {
    Camera camera = framingCamera(voxel, azimuth, 33.0, 1.0, {.orthographic = true});
    camera.orthographicHeight *= 3.0;  // the kernel is larger than the voxel
    const double pixel = camera.orthographicHeight / size.y;
    double sum = 0.0;
    for (const SplatSums& s : device->sums(camera, {.size = size, .method = SplatSettings{}})) sum += s.depth * pixel * pixel;
    worst.take(std::abs(sum / expected - 1.0), [&] { return fmt::format("from {}, 33", azimuth); });
  }
  return worst.atMost(kIntegralTolerance, "a voxel's footprint integrates to its volume", "relative");
}

Check checkEmpty(const StageMaker& make) {
  const glm::ivec3 size(9);
  const Volume empty = constantVolume(size, cubeTransform(size), 0.0);
  const auto device = make(empty, physical(1.0, glm::vec3(1.0f)), {});
  MaxError worst;
  for (const Composite composite : {Composite::Normalised, Composite::Additive}) {
    const FrameSettings settings{.size = {32, 32}, .method = SplatSettings{.composite = composite}, .depth = true};
    const Image image = device->image(framingCamera(empty, 35.0, 25.0, 1.0, {}), settings);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const auto where = [&] { return pixelText(settings.size, i); };
      for (int c = 0; c < 4; ++c) worst.take(std::abs(double(image.pixels[i][c])), where);
      worst.take(std::isinf(image.depth[i]) ? 0.0 : 1.0, where);
    }
  }
  return worst.atMost(0.0, "an empty volume is transparent and infinitely far");
}

/// p and q side by side in front, s and t behind them (Figure 4): E = w a_p + w' a_q + (1 - a_p) w a_p + ...
Check checkTwoVoxels(const StageMaker& make) {
  const double a = 127.0 / 255.0, b = 51.0 / 255.0;  // linear8 holds 1 - a and 1 - b exactly
  const Volume volume =
      makeVolume({2, 1, 2}, glm::dmat4(1.0), [&](int x, int, int) { return extinctionOf(x == 0 ? a : b); });
  const auto device = make(volume, physical(1.0, glm::vec3(1.0f)), {.code = AttenuationCode::Linear8});
  MaxError worst;
  for (const double x : {0.0, 0.2, 0.5, 0.9}) {
    const double p = footprintAt(x) * a, q = footprintAt(1.0 - x) * b;
    const double expected = p + q + (1.0 - a) * p + (1.0 - b) * q;
    const double energy =
        device->sums(lookingDown(x, 0.0, 1e-3), {.size = {1, 1}, .method = SplatSettings{.gradient = false}}).at(0).energy;
    worst.take(std::abs(energy - expected), [&] { return fmt::format("x = {}", x); });
  }
  return worst.atMost(kRoundingTolerance, "two layers of two voxels add up as Eq. 10");
}

/// Full layers of equal opacity: Eq. 8, where alpha blending (Eq. 9) leaks. Additive: there a voxel is a
/// layer of its own, and E is an opacity.
Check checkFullLayers(const StageMaker& make) {
  const double alpha = 153.0 / 255.0;
  const Volume volume = constantVolume({7, 7, 2}, glm::dmat4(1.0), 1.0);
  const auto device =
      make(volume, physical(extinctionOf(alpha), glm::vec3(1.0f)), {.code = AttenuationCode::Linear8});
  const double expected = alpha + (1.0 - alpha) * alpha;
  MaxError worst;
  for (const glm::dvec2 at : {glm::dvec2(3.0, 3.0), glm::dvec2(3.5, 3.0), glm::dvec2(3.3, 2.6)}) {
    const double energy =
        device->sums(lookingDown(at.x, at.y, 1e-3), {.size = {1, 1}, .method = SplatSettings{.composite = Composite::Additive}})
            .at(0)
            .energy;
    worst.take(std::abs(energy / expected - 1.0), [&] { return fmt::format("({}, {})", at.x, at.y); });
  }
  return worst.atMost(kRippleTolerance, "two full layers compose as Eq. 8", "relative");
}

}  // namespace

ReportSection closedForms(const StageMaker& make, int edge) {
  ReportSection section{.title = "Closed forms",
                        .text = "What the device makes of volumes whose answer can be written down."};
  for (const AttenuationCode code : {AttenuationCode::Depth8, AttenuationCode::Linear8})
    section.checks.push_back(checkTable(make, code));
  checkCube(make, edge, section);
  for (const auto& check : {checkSingleVoxel, checkEmpty, checkTwoVoxels, checkFullLayers})
    section.checks.push_back(check(make));
  return section;
}

}  // namespace freevoxels
