// What cannot be seen from any direction of the table has no codes of its own, and nothing looks different.

#include "engine/attenuation/table_levels.h"
#include "engine/attenuation/table_pruning.h"

#include "engine/octree/medium_levels.h"
#include "engine/octree/volume_builder.h"
#include "engine/renderer.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

/// Optical depths of a voxel: the code depth8 ends after one, and after none of the way through.
constexpr double kOpaque = 20.0, kFog = 0.1;

using Codes = std::vector<std::vector<std::uint8_t>>;

class SeenRunsTest : public DeviceTest {
 protected:
  /// A full box of which a layer takes most of the light, but for one part.
  static Volume opaqueVolume() {
    const glm::ivec3 size(45, 38, 51);
    return makeVolume(size, cubeTransform(size), [](int x, int y, int z) {
      return x > 30 && y < 10 ? 0.01 : 1.0 + 0.125 * double((x + 3 * y + 5 * z) % 8);
    });
  }
  static Classification classification(const Volume& volume, double depthPerVoxel) {
    return {.densityScale = depthPerVoxel / volume.voxelSize()};
  }

  struct Made {
    std::vector<StageTime> times;
    BuiltVolume built;
    AttenuationTable table;

    Made(const Volume& volume, const Classification& classification, const TableSettings& settings)
        : built(buildVolume(device(), volume, classification, times)),
          table(makeTable(device(), built.volume, settings)) {
      AttenuationSweep sweep(device(), settings);
      Commands commands(device());
      sweep.record(commands, built.volume, table);
      TableLevels levels(device(), settings);
      levels.record(commands, built.volume, built.lists.steps, table);
      commands.submitAndWait();
    }
    /// Codes and bounds of all levels.
    std::vector<Codes> all() const {
      std::vector<Codes> result;
      for (int level = 0; level <= built.volume.hierarchy.top(); ++level) {
        result.push_back(downloadTable(device(), built.volume, table, level));
        if (level > 0) result.push_back(downloadBounds(device(), built.volume, table, level));
      }
      return result;
    }
  };
};

TEST_F(SeenRunsTest, HaveAllCodesThatAreNotTheDarkest) {
  const Volume volume = opaqueVolume();
  for (const AttenuationCode code : {AttenuationCode::Depth8, AttenuationCode::Linear8})
    for (const DirectionSet set : {DirectionSet::Directions26, DirectionSet::Directions98}) {
      Made made(volume, classification(volume, kOpaque), {.code = code, .directions = set});
      const std::vector<Codes> before = made.all();
      const std::uint64_t bytes = made.table.bytes();
      pruneOpaqueRuns(device(), made.table, made.times);
      EXPECT_LT(made.table.bytes(), bytes / 2);
      EXPECT_EQ(made.all(), before);
    }
}

TEST_F(SeenRunsTest, AreAllThatThereIsOfFog) {
  const Volume volume = opaqueVolume();
  Made made(volume, classification(volume, kFog), {});
  const std::uint64_t bytes = made.table.bytes();
  pruneOpaqueRuns(device(), made.table, made.times);
  EXPECT_EQ(made.table.bytes(), bytes);
  EXPECT_EQ(made.table.keptRuns.bytes(), 0u);
}

/// The first frame reads no levels: its table is whole.
TEST_F(SeenRunsTest, GiveTheSameImagesBitForBit) {
  const Volume volume = opaqueVolume();
  const glm::dvec3 middle(volume.indexToWorld * glm::dvec4(glm::dvec3(volume.dimensions) / 2.0, 1.0));
  FrameSettings whole{.size = {64, 64}, .lod = 0.0f, .culling = false};
  whole.attenuation = AttenuationLookup::Bilinear;
  FrameSettings lit = whole;
  lit.lighting = Lighting{.lights = {{.place = {1.0, 2.0, 3.0}}, {.place = middle, .atInfinity = false}},
                          .ambient = glm::vec3(0.3f),
                          .attenuation = LightAttenuation::Table};
  const Camera outside = framingCamera(volume, 35.0, 25.0, 1.0, {});
  Camera inside = outside;
  inside.position = middle;
  inside.lookAt = middle + glm::dvec3(1.0, 0.3, 0.2);
  Renderer renderer(device(), volume, classification(volume, kOpaque), {});
  const auto images = [&] {
    std::vector<std::vector<glm::vec4>> pixels;
    for (const Camera& camera : {outside, inside})
      for (const FrameSettings& settings : {whole, lit})
        pixels.push_back(renderer.render(camera, settings).pixels);
    return pixels;
  };
  const auto expected = images();
  const std::uint64_t bytes = renderer.memory().stored();
  renderer.render(outside, {.size = {64, 64}});
  EXPECT_LT(renderer.memory().stored(), bytes);
  EXPECT_EQ(images(), expected);
}

}  // namespace
}  // namespace freevoxels
