// Scattering in octaves beside path-traced images: tests/path_traced/README.md says what they show.

#include "engine/image/flip.h"
#include "tests/device/splat_fixture.h"

namespace freevoxels {
namespace {

class MultipleScatteringTest : public SplatTest {};

double meanOf(const Image& image) {
  double sum = 0.0;
  for (const glm::vec4& pixel : image.pixels) sum += pixel.r + pixel.g + pixel.b;
  return sum / (3.0 * double(image.pixels.size()));
}

TEST_F(MultipleScatteringTest, ThreeOctavesHaveHalfTheErrorOfSingleScattering) {
  const Volume cloud = makeProcedural("cloud", 48);
  Renderer renderer(device(), cloud, {.densityScale = 20.0, .albedo = glm::vec3(0.99f)}, {});
  const Camera camera{.position = {1.2, 0.8, 1.6}, .lookAt = {0.0, -0.05, 0.0}};
  struct Case {
    const char* name;
    glm::dvec3 toLight;
  };
  for (const Case& light : {Case{"key", {-0.32, 0.85, 0.42}}, Case{"side", {1.0, 0.2, -0.3}}, Case{"back", {-0.5, 0.4, -1.0}}}) {
    SCOPED_TRACE(light.name);
    const Image truth = readExr(std::filesystem::path(FREEVOXELS_PATH_TRACED) / fmt::format("cloud_{}.exr", light.name));
    FrameSettings settings{.size = truth.size, .lighting = Lighting{.lights = {{.place = light.toLight}}}};
    settings.lighting->attenuation = LightAttenuation::Exact;
    const Image once = renderer.render(camera, settings);
    settings.lighting->scattering = 3;
    settings.lighting->scatteringScale = 0.5;
    const Image thrice = renderer.render(camera, settings);
    EXPECT_LT(ldrFlip(thrice, truth).mean(), 0.5 * ldrFlip(once, truth).mean());
    EXPECT_LT(std::abs(meanOf(thrice) - meanOf(truth)), 0.5 * std::abs(meanOf(once) - meanOf(truth)));
  }
}

}  // namespace
}  // namespace freevoxels
