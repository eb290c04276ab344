#include "apps/view/overlays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "apps/common/annotation.h"

namespace freevoxels {
namespace {

TEST(Overlays, ScaleBarsHaveRoundLengths) {
  for (const auto& [length, round] : {std::pair(1.0, 1.0), {1.9, 1.0}, {2.0, 2.0}, {4.99, 2.0}, {5.1, 5.0}, {73.0, 50.0}, {0.034, 0.02}})
    EXPECT_NEAR(roundLength(length), round, 1e-12 * round) << length;
}

TEST(Overlays, APixelAtTheLookAtPointHasItsLength) {
  Camera camera;
  camera.position = {0.0, 0.0, 10.0};
  camera.verticalFov = 90.0;
  EXPECT_NEAR(pixelLength(camera, 200.0), 0.1, 1e-12);
  camera.orthographic = true;
  camera.orthographicHeight = 4.0;
  EXPECT_NEAR(pixelLength(camera, 200.0), 0.02, 1e-12);
}

TEST(Overlays, WorldPositionsHaveThePlacesThatTheyHaveInTheImage) {
  const ImageFrame frame{{100.0f, 50.0f}, {500.0f, 250.0f}};
  Camera camera;
  camera.position = {0.0, 0.0, 10.0};
  camera.lookAt = glm::dvec3(0.0);
  camera.verticalFov = 90.0;
  const auto middle = frame.place(camera, glm::dvec3(0.0)), corner = frame.place(camera, {10.0, 10.0, 0.0});
  ASSERT_TRUE(middle && corner);
  EXPECT_NEAR(middle->x, 300.0f, 1e-3f);
  EXPECT_NEAR(middle->y, 150.0f, 1e-3f);
  EXPECT_NEAR(corner->x, 400.0f, 1e-3f) << "half the height to the right";
  EXPECT_NEAR(corner->y, 50.0f, 1e-3f) << "the upper edge";
  EXPECT_FALSE(frame.place(camera, {0.0, 0.0, 11.0})) << "behind the eye";
}

TEST(Overlays, WhatIsDrawnOverASmallImageTakesTurns) {
  const ImageFrame frame{{100.0f, 50.0f}, {300.0f, 150.0f}};
  OverlayRoom room(frame, 5.0f);
  EXPECT_FALSE(room.take({90.0f, 60.0f}, {120.0f, 80.0f})) << "it begins left of the image";
  EXPECT_FALSE(room.take({110.0f, 60.0f}, {211.0f, 80.0f})) << "wider than half of the image";
  EXPECT_FALSE(room.take({110.0f, 60.0f}, {120.0f, 111.0f})) << "higher than half of it";
  EXPECT_TRUE(room.take({110.0f, 100.0f}, {150.0f, 140.0f}));
  EXPECT_FALSE(room.take({120.0f, 110.0f}, {130.0f, 120.0f})) << "in what was taken";
  EXPECT_FALSE(room.take({154.0f, 100.0f}, {200.0f, 140.0f})) << "too near to that";
  EXPECT_TRUE(room.take({156.0f, 100.0f}, {200.0f, 140.0f}));
  EXPECT_TRUE(room.take({110.0f, 60.0f}, {200.0f, 94.0f})) << "above both";
}

TEST(Overlays, WhatIsDraggedStaysUnderTheMouse) {
  const ImageFrame frame{{10.0f, 20.0f}, {410.0f, 320.0f}};
  for (const bool orthographic : {false, true}) {
    Camera camera;
    camera.position = {3.0, 2.0, 4.0};
    camera.lookAt = {0.2, 0.1, -0.3};
    camera.orthographic = orthographic;
    camera.orthographicHeight = 2.5;
    const glm::dvec3 position(0.8, -0.4, 1.1);
    const auto before = frame.place(camera, position);
    const auto after = frame.place(camera, position + wayBeside(camera, position, {37.0, -11.0}, 300.0));
    ASSERT_TRUE(before && after);
    EXPECT_NEAR(after->x - before->x, 37.0f, 1e-3f);
    EXPECT_NEAR(after->y - before->y, 11.0f, 1e-3f);
  }
}

TEST(Overlays, APlaneCutsTheBoxInAPolygonWhoseCornersAreInOrder) {
  Volume volume{.dimensions = glm::ivec3(4)};
  volume.indexToWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(-1.5));  // the box is -2 to 2
  const std::vector<glm::dvec3> square = planeInBox(volume, {.point = {0.5, 9.0, 9.0}, .normal = {3.0, 0.0, 0.0}});
  ASSERT_EQ(square.size(), 4u);
  const std::vector<glm::dvec3> hexagon = planeInBox(volume, {.point = glm::dvec3(0.0), .normal = glm::dvec3(1.0)});
  ASSERT_EQ(hexagon.size(), 6u);
  for (const auto* polygon : {&square, &hexagon})
    for (std::size_t i = 0; i < polygon->size(); ++i) {
      const glm::dvec3 from = (*polygon)[i], to = (*polygon)[(i + 1) % polygon->size()];
      EXPECT_NEAR(glm::distance(from, to), polygon == &square ? 4.0 : std::sqrt(8.0), 1e-12) << "not across the polygon";
    }
  for (const glm::dvec3 corner : square) EXPECT_NEAR(corner.x, 0.5, 1e-12);
  EXPECT_TRUE(planeInBox(volume, {.point = {2.1, 0.0, 0.0}, .normal = {1.0, 0.0, 0.0}}).empty());
}

TEST(Overlays, ASideOfTheClipBoxStaysInsideAndDoesNotPassTheOther) {
  const VoxelBox box{{2, 0, 0}, {7, 9, 99}};
  const glm::ivec3 dimensions(10);
  EXPECT_EQ(withSideMoved(box, 0, 3, dimensions).first.x, 5);
  EXPECT_EQ(withSideMoved(box, 0, 30, dimensions).first.x, 7);
  EXPECT_EQ(withSideMoved(box, 0, -30, dimensions).first.x, 0);
  EXPECT_EQ(withSideMoved(box, 1, 30, dimensions).last.x, 9);
  EXPECT_EQ(withSideMoved(box, 1, -30, dimensions).last.x, 2);
  EXPECT_EQ(withSideMoved(box, 5, -1, dimensions).last.z, 8) << "from the volume's side, which the box was beyond";
}

}  // namespace
}  // namespace freevoxels
