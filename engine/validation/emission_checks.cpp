#include "engine/validation/emission_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/image/metrics.h"
#include "engine/reference/oracle.h"
#include "engine/renderer.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/validation/max_error.h"
#include "engine/validation/quality_scenes.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

namespace {

constexpr float kKelvin = 1800.0f;
/// Tolerance for a box seen face-on through its middle: the kernels of a constant volume do not add up to a constant exactly
/// (engine/docs/method.md), and codes are rounded.
constexpr double kBoxTolerance = 1e-2;

struct Medium {
  const char* name;
  double densityScale;  ///< as a factor of the automatic one
};
constexpr std::array<Medium, 2> kMedia{{{"flames and smoke", 1.0}, {"flames alone", 0.0}}};

Classification burning(const Volume& volume, double densityScale) {
  Classification classification{.densityScale = densityScale * automaticDensityScale(volume, 2.0),
                                .albedo = glm::vec3(0.1f)};
  classification.emission = Emission{.strength = automaticEmissionStrength(volume, classification, {})};
  return classification;
}

/// A unit cube of one temperature and density.
Volume hotBox(int resolution) {
  const glm::ivec3 n(resolution);
  Volume volume = makeVolume(n, cubeTransform(n), [](int, int, int) { return 1.0; });
  volume.temperature =
      TemperatureGrid{.name = "", .values = ScalarBricks::make(n, [](glm::ivec3) { return kKelvin; })};
  summariseValues(*volume.temperature);
  return volume;
}

/// j (1 - exp(-sigma L)) / sigma, or j L without extinction.
Check checkBoxes(const Device& device, int resolution) {
  const Volume volume = hotBox(resolution);
  const Emission emission{.strength = 0.8};
  const glm::dvec3 light = emittedLight(emission, kKelvin);
  const Camera camera{.position = {0, 0, 3}, .orthographic = true, .orthographicHeight = 0.25};
  MaxError worst;
  for (const double depth : {0.0, 0.5, 2.0, 8.0}) {
    const Classification classification{
        .densityScale = depth, .albedo = glm::vec3(0.0f), .emission = emission};
    Renderer renderer(device, volume, classification, {});
    const glm::dvec3 expected = light * (depth > 0.0 ? -std::expm1(-depth) / depth : 1.0);
    for (const glm::vec4& pixel : renderer.render(camera, {.size = {8, 8}}).pixels)
      for (int c = 0; c < 2; ++c)
        worst.take(std::abs(double(pixel[c]) / expected[c] - 1.0), [&] { return fmt::format("optical depth {:g}", depth); });
  }
  return worst.atMost(kBoxTolerance, "a box of one temperature: radiance against the closed form",
                      "relative");
}

void checkFire(const Device& device, const Volume& volume, const Medium& medium, int edge,
               ReportSection& section) {
  const Classification classification = burning(volume, medium.densityScale);
  Renderer renderer(device, volume, classification, {});
  Check check{.name = medium.name, .bound = Check::Bound::AtLeast, .tolerance = kFirePsnr, .unit = "dB"};
  const QualityView views[] = {{}, {.azimuth = 200.0, .elevation = -20.0}};
  for (const QualityView& view : views) {
    const Camera camera = viewCamera(volume, view);
    const Image oracle =
        renderOracle(volume, classification, camera, {.size = glm::ivec2(edge), .tolerance = 4e-3}).image;
    ImageRow row{
        .caption = fmt::format("{}, {}", medium.name, viewText(view)), .images = {{"oracle", oracle}}, .background = glm::vec3(0.0f)};
    const Image image = renderer.render(camera, {.size = glm::ivec2(edge)});
    row.images.push_back({"default", image});
    const double psnr = compareImages(image, oracle).psnr;
    if (&view == views || psnr < check.figure) {
      check.figure = psnr;
      check.where = viewText(view);
    }
    section.imageRows.push_back(std::move(row));
  }
  section.checks.push_back(check);
}

}  // namespace

ReportSection emissionChecks(const Device& device, int resolution, int imageEdge) {
  ReportSection section{.title = fmt::format("Emission: procedural:fire, {0}x{0}x{0} voxels", resolution),
                        .text =
                            "What is hot sends out light: against the oracle, and a box of one temperature "
                            "against closed forms."};
  Volume volume = makeProcedural("fire", resolution);
  cropToActive(volume);
  section.checks.push_back(checkBoxes(device, resolution));
  for (const Medium& medium : kMedia) checkFire(device, volume, medium, imageEdge, section);
  return section;
}

}  // namespace freevoxels
