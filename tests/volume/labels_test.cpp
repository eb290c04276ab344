// Segmentations: which labels of which grids are drawn, and how.

#include "engine/volume/labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/description/label_words.h"
#include "engine/description/scene_description.h"
#include "engine/volume/volume_of_scalars.h"
#include "tests/volume/vdb_fixture.h"

namespace freevoxels {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using test::expectRefusal;
using test::kPlenty;
using test::Vdb;

const LabelRequest kNoRequest;

glm::vec3 colorAt(const Volume& volume, glm::ivec3 voxel) {
  return albedoOf({}, *volume.albedo, voxel);
}

/// Voxels of a solid: half of the density of a surface is on either side of it.
std::size_t solidVoxels(const Volume& volume, float half = 0.5f) {
  return std::size_t(std::ranges::count_if(denseScalars(volume), [half](float density) { return density >= half; }));
}

/// A label a cube of 5^3 voxels, along x from 0 on; between the cubes, active voxels of 0.
template <typename Grid>
typename Grid::Ptr cubes(const std::vector<typename Grid::ValueType>& labels) {
  const typename Grid::Ptr grid = Grid::create(typename Grid::ValueType(0));
  grid->setName("parts");
  grid->denseFill(CoordBBox(Coord(-20, -20, -20), Coord(8 * int(labels.size()), 30, 30)), typename Grid::ValueType(0), true);
  for (int i = 0; i < int(labels.size()); ++i)
    grid->denseFill(CoordBBox(Coord(8 * i, 0, 0), Coord(8 * i + 4, 4, 4)), labels[std::size_t(i)], true);
  return grid;
}

TEST(Labels, AutomaticColoursOfNeighboursAreFarApart) {
  for (std::int64_t label = -20; label < 200; ++label)
    for (std::int64_t other = label + 1; other < label + 5; ++other)
      EXPECT_GT(glm::distance(automaticLabelColor(label), automaticLabelColor(other)), 0.15f) << label << " " << other;
}

TEST(Labels, WordsAreReadAndWritten) {
  for (const std::string text : {"all", "none", "1,5,9", "-3,7=#d0a080", "all,2=#ff0000@0.25,8@0", "9007199254740992"})
    EXPECT_EQ(labelsText(readLabels("labels", text)), text);
  EXPECT_EQ(labelsText(readLabels("labels", "4=red")), "4=#ff0000");
  EXPECT_TRUE(readLabels("labels", "all").shows(77));
  EXPECT_FALSE(readLabels("labels", "1,2").shows(77));
  for (const std::string text : {"", "1,,2", "1=", "1=pink2", "1@2", "1@x", "1.5", "a=red", "1e300"})
    expectRefusal([&] { readLabels("labels", text); }, ErrorKind::Usage, {"labels"});
}

TEST_F(Vdb, WholeNumbersBecomeSolidsInTheColoursOfTheirLabels) {
  write({cubes<openvdb::Int32Grid>({1, 7, -2}), test::named<openvdb::Int64Grid>(cubes<openvdb::Int64Grid>({1, 7, -2}), "long")});
  for (const std::string grid : {"parts", "long"}) {
    const Volume volume = readVdb(file, {.grid = grid, .maximumVoxels = kPlenty, .labels = {.labels = Labels()}});
    EXPECT_TRUE(volume.isSolid);
    EXPECT_EQ(solidVoxels(volume), 3u * 125u) << "voxels of 0 are no part";
    EXPECT_EQ(volume.dimensions, glm::ivec3(21 + 4, 5 + 4, 5 + 4)) << "two voxels on each side, for the light";
    const glm::ivec3 first = -volume.indexOrigin;
    EXPECT_EQ(volume.scalars.at(first), 0.5f) << "a corner";
    EXPECT_EQ(volume.scalars.at(first + 2), 1.0f);
    EXPECT_EQ(colorAt(volume, first), automaticLabelColor(1));
    EXPECT_EQ(colorAt(volume, first + glm::ivec3(12, 4, 4)), automaticLabelColor(7));
    EXPECT_EQ(colorAt(volume, first + glm::ivec3(16, 0, 0)), automaticLabelColor(-2));
    EXPECT_LT(volume.scalars.at(first + glm::ivec3(6, 2, 2)), 0.2f) << "between two cubes";
    EXPECT_EQ(colorAt(volume, first + glm::ivec3(7, 2, 2)), automaticLabelColor(7)) << "the nearest";
  }
}

TEST_F(Vdb, LabelsThatAreNotListedAreNotDrawn) {
  write({cubes<openvdb::Int32Grid>({1, 7, 2})});
  Labels labels{.showsAll = false, .styles = {{7, {.color = glm::vec3(1, 0, 0), .opacity = 0.5f}}}};
  const Volume volume = readVdb(file, {.maximumVoxels = kPlenty, .labels = {.labels = labels}});
  EXPECT_EQ(solidVoxels(volume, 0.5f * volume.scalars.at(glm::ivec3(4))), 125u);
  EXPECT_EQ(volume.dimensions, glm::ivec3(5 + 4));
  EXPECT_EQ(colorAt(volume, glm::ivec3(4)), glm::vec3(1, 0, 0));
  EXPECT_NEAR(-std::expm1(-volume.scalars.at(glm::ivec3(4)) * kSolidOpticalDepth), 0.5, 1e-6) << "opacity of a voxel";
  labels.styles = {{3, {}}};
  expectRefusal([&] { readVdb(file, {.maximumVoxels = kPlenty, .labels = {.labels = labels}}); }, ErrorKind::Input, {"no", "label"});
}

TEST_F(Vdb, BooleansAndMasksAreOneLabel) {
  const openvdb::MaskGrid::Ptr mask = openvdb::MaskGrid::create();
  mask->setName("mask");
  mask->sparseFill(CoordBBox(Coord(3), Coord(40)), true, true);  // with tiles
  write({cubes<openvdb::BoolGrid>({true, false, true}), mask});
  const Volume parts = readVdb(file, {.grid = "parts", .maximumVoxels = kPlenty, .labels = {.labels = Labels()}});
  EXPECT_EQ(solidVoxels(parts), 2u * 125u);
  const Volume masked = readVdb(file, {.grid = "mask", .maximumVoxels = kPlenty, .labels = {.labels = Labels()}});
  EXPECT_EQ(solidVoxels(masked), 38u * 38u * 38u);
  EXPECT_EQ(colorAt(masked, glm::ivec3(10)), automaticLabelColor(1));
}

TEST_F(Vdb, WholeNumbersAreScalarsWhereTheyAreNoLabels) {
  write({cubes<openvdb::Int32Grid>({1, 7, 3})});
  const Volume volume = readVdb(file, {.maximumVoxels = kPlenty, .labels = kNoRequest});
  EXPECT_FALSE(volume.albedo.has_value());
  EXPECT_EQ(volume.maximum, 7.0f);
  EXPECT_EQ(ClassificationDescription{.densityScale = 2.0}.labelRequest().of(true), nullptr);
  EXPECT_EQ(ClassificationDescription{.labels = readLabels("", "none")}.labelRequest().of(true), nullptr);
  EXPECT_NE(ClassificationDescription().labelRequest().of(true), nullptr);
  EXPECT_EQ(ClassificationDescription().labelRequest().of(false), nullptr) << "real numbers";
}

TEST_F(Vdb, RealNumbersAreLabelsIfThatIsAskedFor) {
  write({cubes<openvdb::FloatGrid>({1.0f, 7.0f, 2e6f})});  // which would be an outlier among scalars
  const Volume volume = readVdb(file, {.maximumVoxels = kPlenty, .labels = {.labels = Labels(), .ofAllGrids = true}});
  EXPECT_EQ(solidVoxels(volume), 3u * 125u);
  EXPECT_EQ(volume.outlierVoxels, 0u);
  EXPECT_EQ(colorAt(volume, glm::ivec3(20, 4, 4)), automaticLabelColor(2000000));
}

TEST_F(Vdb, RealNumbersAreChosenBeforeLabels) {
  write({cubes<openvdb::Int32Grid>({1}), test::makeGrid("ct")});
  EXPECT_EQ(readVdb(file, "", kPlenty).source, "test.vdb ct");
}

TEST(Labels, OfAnArrayAreDrawnAsThoseOfAFile) {
  const Labels labels{.showsAll = true, .styles = {{2, {.opacity = 0.0f}}}};
  const auto scalars = [] { return ScalarBricks::make(glm::ivec3(9, 3, 4), [](glm::ivec3 v) { return float(v.x % 3); }); };
  const Volume volume = volumeOfScalars(scalars(), glm::dmat4(1.0), NoData{}, "the array", &labels);
  EXPECT_EQ(solidVoxels(volume), 3u * 3u * 4u);
  EXPECT_EQ(volume.up, glm::dvec3(0.0, 1.0, 0.0));
  EXPECT_EQ(colorAt(volume, glm::ivec3(4, 2, 3)), automaticLabelColor(1));
  const Labels others{.showsAll = false, .styles = {{5, {}}}};
  expectRefusal([&] { volumeOfScalars(scalars(), glm::dmat4(1.0), NoData{}, "the array", &others); }, ErrorKind::Input, {"label"});
}

}  // namespace
}  // namespace freevoxels
