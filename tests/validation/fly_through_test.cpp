#include "engine/validation/fly_through.h"

#include "engine/validation/fly_through_quality.h"
#include "engine/volume/subject.h"
#include "tests/splatting/framed_box.h"

namespace freevoxels {
namespace {

using test::box;
using test::obliqueTransform;

TEST(FlyThrough, GoesThroughTheCentreAndSeesTheVolumeFromBothEnds) {
  const Volume volume = box({20, 9, 13}, obliqueTransform());
  const glm::dvec3 centre(volume.indexToWorld * glm::dvec4(9.5, 4.0, 6.0, 1.0));
  const std::vector<Camera> cameras = flyThrough(volume, 9);
  ASSERT_EQ(cameras.size(), 9u);
  for (const Camera& camera : cameras) ASSERT_NO_THROW(checkCamera(camera));
  EXPECT_NEAR(glm::length(cameras[4].position - centre), 0.0, 1e-9 * glm::length(centre));
  EXPECT_TRUE(eyeIsInside(cameras[4], volume.dimensions, volume.indexToWorld));
  for (const std::size_t end : {0u, 8u}) {
    const Camera& camera = cameras[end];
    EXPECT_FALSE(eyeIsInside(camera, volume.dimensions, volume.indexToWorld));
    const glm::dvec3 view = glm::normalize(camera.lookAt - camera.position);
    EXPECT_GT(glm::dot(view, glm::normalize(centre - camera.position)), 0.999999);
  }
}

TEST(FlyThrough, WrongChangeIsWhatTheTruthDoesNotDo) {
  const auto grey = [](float value) {
    return Image{.size = {4, 4}, .pixels = std::vector(16, glm::vec4(value)), .depth = {}};
  };
  EXPECT_NEAR(wrongChange(grey(0.1f), grey(0.4f), grey(0.2f), grey(0.5f)), 0.0, 1e-7);
  EXPECT_NEAR(wrongChange(grey(0.1f), grey(0.4f), grey(0.2f), grey(0.2f)), 0.3, 1e-7);
}

TEST(EyeIsInside, UpToTheFacesOfTheBoxAndNeverOrthographic) {
  const glm::ivec3 dimensions(4, 2, 3);
  Camera camera;
  const auto inside = [&](glm::dvec3 eye) {
    camera.position = eye;
    return eyeIsInside(camera, dimensions, glm::dmat4(1.0));
  };
  EXPECT_TRUE(inside({3.5, 1.5, -0.5}));
  EXPECT_FALSE(inside({3.6, 1.0, 1.0}));
  EXPECT_FALSE(inside({1.0, 1.0, -0.6}));
  camera.orthographic = true;
  EXPECT_FALSE(inside({1.0, 1.0, 1.0}));
}

}  // namespace
}  // namespace freevoxels
