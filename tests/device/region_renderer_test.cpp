// Baked volumes that are drawn region by region: the table of a region is that of the whole volume, and the image does not depend on
// how many regions the device holds.

#include "engine/region_renderer.h"

#include <cmath>

#include "engine/attenuation/attenuation_table.h"
#include "engine/octree/volume_builder.h"
#include "engine/renderer_stages.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using fvx::FvxFile;
using fvx::RegionEntry;
using Table = std::vector<std::vector<std::uint8_t>>;

const Classification kThin{.densityScale = 0.4};

class RegionRendererTest : public DeviceTest {
 protected:
  /// Regions with and without neighbours on each side, the last ones narrower than a halo.
  static Volume noise() { return randomVolume({131, 66, 67}, shearedTransform({131, 66, 67}), 0.5, 3.0); }

  std::shared_ptr<const FvxFile> bake(const Volume& volume, const Classification& classification, bool keepScalars = true) const {
    bakeVolume(folder_ / "a.fvx", volume, classification, {.keepScalars = keepScalars});
    return std::make_shared<const FvxFile>(folder_ / "a.fvx");
  }

  struct View {
    Camera camera;
    FrameSettings settings;
  };
  /// From a corner, with a light at infinity, one beside the volume and ambient light.
  static View litView(const Volume& volume) {
    View view{.camera = framingCamera(volume, 35.0, 25.0, 1.0, {}), .settings = {.size = {72, 64}, .lod = 0.0f, .depth = true}};
    view.settings.attenuation = AttenuationLookup::Bilinear;
    view.settings.lighting = Lighting{.ambient = glm::dvec3(0.2)};
    view.settings.lighting->attenuation = LightAttenuation::Table;
    view.settings.lighting->lights = {{.place = {1.0, 0.7, 0.2}}, {.place = {-2.0, 3.0, 1.5}, .atInfinity = false, .intensity = 2.0}};
    return view;
  }

  FixedSums sumsWith(const Device& device, const std::shared_ptr<const FvxFile>& file, const View& view, bool keepsRegions,
                     const SharePart& part = {}) const {
    RegionRenderer renderer(device, file, kThin, {}, keepsRegions);
    if (keepsRegions) renderer.renderShares(view.camera, view.settings, part);
    return renderer.renderShares(view.camera, view.settings, part);
  }

  const test::TemporaryFolder folder_;
};

TEST_F(RegionRendererTest, ARegionsTableIsThatOfTheWholeVolumeToACode) {
  const Volume volume = noise();
  const auto file = bake(volume, kThin);
  const Table whole = RendererStages(Renderer(device(), volume, kThin, {})).downloadTable();
  RegionRenderer renderer(device(), file, kThin, {}, false);
  std::size_t compared = 0, unequal = 0;
  double squares = 0.0;
  for (const RegionEntry& region : file->regions(0)) {
    const Table table = downloadTable(renderer, region);
    const fvx::VoxelBox box = fvx::regionWithHalo(region.cell, volume.dimensions);
    const glm::ivec3 extent = box.extent();
    for (std::size_t d = 0; d < table.size(); ++d)
      for (glm::ivec3 v(0); v.z < extent.z; ++v.z)
        for (v.y = 0; v.y < extent.y; ++v.y)
          for (v.x = 0; v.x < extent.x; ++v.x) {
            const glm::ivec3 place = v + box.first;
            if (!(volume.scalar(place.x, place.y, place.z) > 0.0f)) continue;
            const int restored = table[d][std::size_t(v.x + extent.x * (v.y + extent.y * v.z))];
            const int swept = whole[d][volume.at(place.x, place.y, place.z)];
            ASSERT_LE(std::abs(restored - swept), 1) << "direction " << d << ", voxel " << place.x << "," << place.y << "," << place.z;
            ++compared;
            unequal += restored != swept ? 1 : 0;
            const auto transmittance = [](int code) { return std::exp(-decodeOpticalDepth(AttenuationCode::Depth8, code)); };
            squares += std::pow(transmittance(restored) - transmittance(swept), 2.0);
          }
  }
  ASSERT_GT(compared, std::size_t(1) << 20);
  EXPECT_LT(double(unequal) / double(compared), 0.01);
  EXPECT_GT(-10.0 * std::log10(squares / double(compared)), 65.0);  // dB
}

TEST_F(RegionRendererTest, CpuAndGpuSweepARegionToTheSameTableInSlabsAndAtOnce) {
  const auto file = bake(noise(), kThin);
  std::vector<StageTime> times;
  const BakedRegion region = readBakedRegion(*file, file->regions(0)[file->regions(0).size() / 2]);
  const BuiltVolume built = buildVolume(device(), region.volume, kThin, times);
  const DeviceEntryDepths depths(device(), region.volume.dimensions, region.depths);
  std::vector<Table> tables;
  for (const SweepStyle style :
       {SweepStyle{.voxelsPerThread = 16, .slabBytes = 1 << 24}, SweepStyle{.voxelsPerThread = 4, .tiledRows = true, .slabBytes = 1 << 24},
        SweepStyle{.voxelsPerThread = 4, .tiledRows = true, .slabBytes = 0, .mostSlabBytes = 0}}) {
    AttenuationSweep sweep(device(), {}, style, true);
    const AttenuationTable table = makeTable(device(), built.volume, {});
    Commands commands(device());
    sweep.record(commands, built.volume, table, depths);
    commands.submitAndWait();
    tables.push_back(downloadTable(device(), built.volume, table));
  }
  EXPECT_EQ(tables[1], tables[0]);
  EXPECT_EQ(tables[2], tables[0]);
}

TEST_F(RegionRendererTest, TheSumsHaveTheSameBitsWithAnyMemoryAndAnyParts) {
  const Volume volume = noise();
  const auto file = bake(volume, kThin);
  const View view = litView(volume);
  const FixedSums all = sumsWith(device(), file, view, true);
  EXPECT_NE(all.values, std::vector<std::int64_t>(all.values.size(), 0));
  EXPECT_EQ(sumsWith(device(), file, view, false).values, all.values) << "one region at a time";
  for (const std::uint64_t mebibytes : {64, 128}) {
    const Device limited(instance(), "", mebibytes << 20);
    EXPECT_EQ(sumsWith(limited, file, view, true).values, all.values) << mebibytes;
    EXPECT_LE(limited.peakBytes(), mebibytes << 20);
  }
  FixedSums sum = sumsWith(device(), file, view, false, {0, 3});
  for (const int index : {1, 2}) sum += sumsWith(device(), file, view, false, {index, 3});
  EXPECT_EQ(sum.values, all.values);
}

TEST_F(RegionRendererTest, TheImageIsThatOfTheWholeVolumesSplats) {
  const Volume volume = noise();
  const auto file = bake(volume, kThin);
  View view = litView(volume);
  for (const Composite composite : {Composite::Normalised, Composite::Additive}) {
    view.settings.composite = composite;
    FrameSettings whole = view.settings;
    whole.cullThreshold = 0.0f;
    const Image expected = Renderer(device(), volume, kThin, {}).render(view.camera, whole);
    const Image image = RegionRenderer(device(), file, kThin, {}, false).render(view.camera, view.settings);
    EXPECT_GT(psnr(image, expected), 70.0);
    ASSERT_EQ(image.depth.size(), expected.depth.size());
  }
}

TEST_F(RegionRendererTest, CoarseLevelsAreReadFromAfarAndWhatIsOutsideTheImageIsNot) {
  const Volume volume = makeProcedural("cloud", 160);
  const Classification classification{.densityScale = 8.0};
  const auto file = bake(volume, classification, false);
  FrameSettings settings{.size = {40, 40}, .attenuation = AttenuationLookup::Bilinear};
  const Camera whole = framingCamera(volume, 35.0, 25.0, 1.0, {});
  RegionRenderer renderer(device(), file, classification, {}, false);
  const Image coarse = renderer.render(whole, settings);
  const RegionRenderer::Counts counts = renderer.counts();
  EXPECT_EQ(counts.drawn[0], 0u);
  EXPECT_GT(counts.drawn[1], 0u);
  settings.lod = 0.0f;
  const Image fine = renderer.render(whole, settings);
  EXPECT_EQ(renderer.counts().drawn[0], file->regions(0).size());
  EXPECT_GT(psnr(coarse, fine), 45.0);
  Camera part = whole;
  part.verticalFov *= 0.03;
  renderer.render(part, settings);
  EXPECT_GT(renderer.counts().read, 0u);
  EXPECT_LT(renderer.counts().read, file->regions(0).size() * 3 / 4);
}

TEST_F(RegionRendererTest, WhatNeedsTheWholeVolumeIsSaid) {
  const Volume volume = makeProcedural("cloud", 40);
  const auto file = bake(volume, kThin);
  const View view = litView(volume);
  const auto why = [&](const Classification& classification, const TableSettings& table, const Camera& camera,
                       const FrameSettings& settings) {
    return RegionRenderer::whyNot(*file, classification, table, {camera}, settings).value_or("");
  };
  EXPECT_EQ(why(kThin, {}, view.camera, view.settings), "");
  EXPECT_NE(why({.densityScale = 0.5}, {}, view.camera, view.settings), "");
  EXPECT_NE(why(kThin, {.directions = DirectionSet::Directions98}, view.camera, view.settings), "");
  EXPECT_NE(why(kThin, {.pathLengthCorrection = false}, view.camera, view.settings), "");
  Camera inside = view.camera;
  inside.position = inside.lookAt;
  inside.lookAt += glm::dvec3(0.1, 0.0, 0.0);
  EXPECT_NE(why(kThin, {}, inside, view.settings), "");
  FrameSettings settings = view.settings;
  settings.attenuation = AttenuationLookup::Exact;
  EXPECT_NE(why(kThin, {}, view.camera, settings), "");
  settings = view.settings;
  settings.lighting->lights[1].place = view.camera.lookAt;
  EXPECT_NE(why(kThin, {}, view.camera, settings), "");
  const auto scan = bake(volume, coloured(volume));
  EXPECT_FALSE(scan->hasRegions());
}

}  // namespace
}  // namespace freevoxels
