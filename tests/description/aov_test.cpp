#include "engine/description/aov.h"

#include <limits>

#include "tests/not_finite.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

constexpr glm::ivec2 kSize(24, 16);
using test::kInfinity;

Camera cameraOf(bool orthographic) {
  return {.position = {3.0, 2.0, 6.0}, .lookAt = {0.5, 0.25, 0.0}, .orthographic = orthographic, .verticalFov = 40.0, .orthographicHeight = 5.0};
}

/// What the camera sees of the plane normal * x = offset; the right half of the image sees nothing.
Image planeImage(const Camera& camera, glm::dvec3 normal, double offset) {
  const PixelRays rays = pixelRays(camera, kSize, glm::dmat4(1.0));
  Image image{.size = kSize};
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const double u = x + 0.5, v = y + 0.5;
      const glm::dvec3 origin = rays.origin + u * rays.originX + v * rays.originY;
      const glm::dvec3 direction = rays.direction + u * rays.directionX + v * rays.directionY;
      const bool seen = x < kSize.x / 2;
      image.depth.push_back(seen ? float((offset - glm::dot(normal, origin)) / glm::dot(normal, direction)) : float(kInfinity));
      image.pixels.emplace_back(0.1f, 0.1f, 0.1f, seen ? 0.75f : 0.0f);
    }
  return image;
}

glm::dvec3 vectorAt(const Image& image, const std::string& name, std::size_t i) {
  return {image.channels.at(name + ".X")[i], image.channels.at(name + ".Y")[i], image.channels.at(name + ".Z")[i]};
}

TEST(Aov, PositionsAndNormalsOfAPlaneLieOnItAndPointToTheEye) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, 0.5, 1.0));
  const double offset = 0.4;
  for (const bool orthographic : {false, true}) {
    SCOPED_TRACE(orthographic);
    const Camera camera = cameraOf(orthographic);
    Image image = planeImage(camera, normal, offset);
    addChannels(image, {.position = true, .normal = true}, camera);
    EXPECT_TRUE(image.depth.empty()) << "only asked for what is made of it";
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) {
        const auto i = std::size_t(y * kSize.x + x);
        const glm::dvec3 point = vectorAt(image, "P", i), direction = vectorAt(image, "N", i);
        if (x >= kSize.x / 2) {
          EXPECT_EQ(point, glm::dvec3(0.0));
          EXPECT_EQ(direction, glm::dvec3(0.0));
          continue;
        }
        EXPECT_NEAR(glm::dot(point, normal), offset, 1e-5);
        EXPECT_LT(glm::length(direction - normal), 1e-4) << x << " " << y;
      }
  }
}

TEST(Aov, TransmittanceIsWhatAlphaLeaves) {
  Image image{.size = {3, 1}, .pixels = {{0, 0, 0, 0}, {0, 0, 0, 0.75f}, {0, 0, 0, 1.5f}}, .depth = {1.0f, 2.0f, 3.0f}};
  addChannels(image, {.depth = true, .transmittance = true}, Camera{});
  EXPECT_EQ(image.channels.at("transmittance.Y"), (std::vector<float>{1.0f, 0.25f, 0.0f}));
  EXPECT_EQ(image.depth.size(), 3u);
}

TEST(Aov, ListsAreReadAndWritten) {
  const Aovs aovs = readAovs("--aov", "normal,depth");
  EXPECT_TRUE(aovs.depth && aovs.normal && !aovs.position && !aovs.transmittance);
  EXPECT_EQ(aovText(aovs), "depth,normal");
  for (const char* bad : {"", "depth,", "depth,albedo", "Depth"})
    test::expectRefusal([&] { readAovs("--aov", bad); }, ErrorKind::Usage, {"--aov", "transmittance"});
}

}  // namespace
}  // namespace freevoxels
