// The device's sort against the standard library's, and the order that it gives the visible voxels.

#include "engine/splatting/depth_sort.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>
#include <random>
#include <span>

#include "engine/octree/volume_builder.h"
#include "engine/reference/reference_sorted.h"
#include "engine/reference/reference_splats.h"
#include "engine/reference/reference_table.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

class DepthSortTest : public DeviceTest {
 protected:
  static std::vector<std::uint32_t> read(const Buffer& buffer, std::size_t count) {
    std::vector<std::uint32_t> values(count);
    download(device(), buffer, std::as_writable_bytes(std::span(values)));
    return values;
  }

  /// Sorts the first `count` of these keys, each with its place as value.
  void expectSorted(const std::vector<std::uint32_t>& keys, std::uint32_t count) {
    std::vector<std::uint32_t> places(keys.size());
    std::iota(places.begin(), places.end(), 0u);
    const RadixSort sort(device());
    const SortPairs pairs = makeSortPairs(device(), keys.size());
    if (!keys.empty()) {
      upload(device(), pairs.keys, std::as_bytes(std::span(keys)));
      upload(device(), pairs.values, std::as_bytes(std::span(places)));
    }
    upload(device(), pairs.count, std::as_bytes(std::span(&count, 1)));
    Commands commands(device());
    commands.beginPass("sort");
    sort.record(commands, pairs);
    commands.submitAndWait();
    std::vector<std::uint32_t> expected = places;
    std::stable_sort(expected.begin(), expected.begin() + count,
                     [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    const std::vector<std::uint32_t> values = read(pairs.values, count), sorted = read(pairs.keys, count);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(values[i], expected[i]) << "place " << i << " of " << count;
      ASSERT_EQ(sorted[i], keys[expected[i]]) << "place " << i << " of " << count;
    }
  }

  /// The visible voxels as the device sorts them for each camera, as indices into Volume::values.
  static std::vector<std::vector<std::uint32_t>> order(const Volume& volume,
                                                       const std::vector<Camera>& cameras) {
    const Classification classification{.densityScale = 1.0};
    std::vector<StageTime> times;
    const auto [onDevice, visible, lists] = buildVolume(device(), volume, classification, times);
    const DepthSort sort(device(), onDevice);
    std::vector<std::vector<std::uint32_t>> orders;
    for (const Camera& camera : cameras) {
      Commands commands(device());
      sort.record(commands, onDevice, visible, camera);
      commands.submitAndWait();
      orders.push_back(read(sort.voxels(), downloadBlockCount(device(), visible)));
      const auto pitch = std::uint32_t(onDevice.layout.rowPitch),
                 columns = std::uint32_t(volume.dimensions.x);
      for (std::uint32_t& voxel : orders.back()) voxel -= voxel / pitch * (pitch - columns);
    }
    return orders;
  }

  static std::vector<std::uint32_t> visibleVoxels(const Volume& volume) {
    return referenceVisibleVoxels(referenceExtinction(volume, {.densityScale = 1.0}));
  }

  static double distance(const Volume& volume, const Camera& camera, std::uint32_t voxel) {
    const glm::uvec3 n(volume.dimensions);
    const glm::dvec4 index(voxel % n.x, voxel / n.x % n.y, voxel / n.x / n.y, 1.0);
    const glm::dvec3 toVoxel = glm::dvec3(volume.indexToWorld * index) - camera.position;
    return camera.orthographic ? glm::dot(toVoxel, glm::normalize(camera.lookAt - camera.position))
                               : glm::length(toVoxel);
  }
};

std::vector<std::uint32_t> randomKeys(std::size_t count, std::uint32_t mask) {
  std::mt19937 random(static_cast<unsigned>(count) + mask);
  std::vector<std::uint32_t> keys(count);
  for (std::uint32_t& key : keys) key = std::uint32_t(random()) & mask;
  return keys;
}

TEST_F(DepthSortTest, SortsAnyCountAsTheStandardLibraryDoes) {
  for (const std::size_t count : {0u, 1u, 2u, 31u, 255u, 256u, 257u, 1000u, 65535u, 65537u, 200000u})
    expectSorted(randomKeys(count, 0xffffffffu), std::uint32_t(count));
}

TEST_F(DepthSortTest, EqualKeysKeepTheirOrder) {
  for (const std::uint32_t mask : {0u, 1u, 0x80000000u, 0x01000100u, 0x00ff0000u})
    expectSorted(randomKeys(70000, mask), 70000);
}

TEST_F(DepthSortTest, LeavesWhatIsBeyondTheCount) {
  expectSorted(randomKeys(3000, 0xffffffffu), 1234);
  expectSorted(randomKeys(3000, 0xffffffffu), 0);
}

/// Every visible voxel once, and none nearer than the one after it by more than 32-bit floats can tell apart
/// at the volume's size (1), however far the eye is.
TEST_F(DepthSortTest, RandomCamerasSeeTheVoxelsBackToFront) {
  const glm::ivec3 dimensions(37, 22, 29);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const bool skewed : {false, true}) {
    glm::dmat4 transform = skewed ? shearedTransform(dimensions) : cubeTransform(dimensions);
    transform = glm::translate(glm::dmat4(1.0), glm::dvec3(1e5, -2e5, 5e4)) * transform;
    const Volume volume = randomVolume(dimensions, transform, 0.7, 1.0);
    const glm::dvec3 middle(transform * glm::dvec4(0.5 * glm::dvec3(dimensions - 1), 1.0));
    std::vector<Camera> cameras;
    for (const double far : {0.3, 2.0, 20.0, 5000.0})
      for (const bool orthographic : {false, true})
        cameras.push_back(
            {.position = middle + far * glm::dvec3(uniform(random), uniform(random), uniform(random)),
             .lookAt = middle,
             .orthographic = orthographic});
    const auto orders = order(volume, cameras);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      std::vector<std::uint32_t> ascending = orders[i];
      std::ranges::sort(ascending);
      ASSERT_EQ(ascending, visibleVoxels(volume));
      for (std::size_t k = 1; k < orders[i].size(); ++k)
        ASSERT_LE(distance(volume, cameras[i], orders[i][k]),
                  distance(volume, cameras[i], orders[i][k - 1]) + 1e-6)
            << "place " << k << ", camera " << i;
    }
  }
}

/// Views along an axis are full of ties, which only the index decides.
TEST_F(DepthSortTest, TiesAreInTheOrderOfTheReference) {
  const glm::ivec3 dimensions(16, 16, 16);
  const Volume volume = randomVolume(dimensions, cubeTransform(dimensions), 0.8, 1.0);
  std::vector<Camera> cameras;
  for (const bool orthographic : {false, true})
    for (const double side : {-1.0, 1.0})
      cameras.push_back({.position = {0.0, 0.0, 3.0 * side}, .lookAt = {}, .orthographic = orthographic});
  const auto orders = order(volume, cameras);
  for (std::size_t i = 0; i < cameras.size(); ++i)
    EXPECT_EQ(orders[i], referenceBackToFront(volume, cameras[i], visibleVoxels(volume))) << "camera " << i;
}

TEST_F(DepthSortTest, EveryChunkOfTheVisibleVoxelsIsSorted) {
  const glm::ivec3 dimensions(112, 104, 100);  // 1,164,800 voxels, and a chunk is 1,048,576
  const Volume volume = makeVolume(dimensions, cubeTransform(dimensions), [](int, int, int) { return 1.0; });
  const Camera camera{.position = {1.0, 2.0, 3.0}, .lookAt = {}};
  const std::vector<std::uint32_t> voxels = order(volume, {camera}).front();
  ASSERT_EQ(voxels.size(), volume.voxelCount());
  for (std::size_t k = 1; k < voxels.size(); ++k)
    ASSERT_LE(distance(volume, camera, voxels[k]), distance(volume, camera, voxels[k - 1]) + 1e-6);
}

TEST_F(DepthSortTest, NothingToSort) {
  const glm::ivec3 dimensions(5);
  const Volume volume = makeVolume(dimensions, cubeTransform(dimensions), [](int, int, int) { return 0.0; });
  EXPECT_TRUE(order(volume, {Camera{}}).front().empty());
}

}  // namespace
}  // namespace freevoxels
