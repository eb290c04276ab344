#include "apps/view/view_state.h"

#include <gtest/gtest.h>

namespace freevoxels {
namespace {

class EditHistoryTest : public testing::Test {
 protected:
  EditHistoryTest() {
    state.scene.camera.size = {300, 200};
    state.camera = Camera{};
    rest();
  }
  void rest() { history.follow(state, false, false); }
  void expose(double stops, bool busy = true) {
    state.scene.output.exposure = stops;
    history.follow(state, true, busy);
  }
  std::optional<double> exposure() const { return state.scene.output.exposure; }

  ViewState state;
  EditHistory history;
};

TEST(ViewState, TakesWhatTheFirstImageChoseUnlessTheFileFixesIt) {
  for (const bool isFixed : {false, true}) {
    Volume volume;
    volume.classificationIsFixed = isFixed;
    Scene first{.volume = std::make_shared<const Volume>(volume), .classification = {}};
    ViewState ofDensities, ofFunction;
    ofDensities.keepScales(first);
    EXPECT_EQ(ofDensities.scene.classification.densityScale.has_value(), !isFixed);
    first.classification.transferFunction = TransferFunction{.opacity = {{0.0f, 0.0f}, {1.0f, 0.5f}}, .color = {{0.0f, glm::vec3(1.0f)}}};
    ofFunction.begin(first);
    EXPECT_EQ(ofFunction.scene.classification.transferFunction.has_value(), !isFixed);
  }
}

TEST(ViewState, ClippingKeepsTheDensityScaleUnlessTheFileHasIt) {
  for (const bool isBaked : {false, true}) {
    Volume volume;
    if (isBaked) volume.classification = std::make_shared<const Classification>();
    const Scene scene{.volume = std::make_shared<const Volume>(volume), .classification = {.densityScale = 3.0}};
    ViewState state;
    state.latest = std::make_shared<const DrawnImage>(DrawnImage{.request = {}, .scene = scene});
    state.clip(VoxelBox{.first = glm::ivec3(1), .last = glm::ivec3(2)}, std::nullopt);
    EXPECT_TRUE(state.scene.input.clipBox);
    EXPECT_EQ(state.scene.classification.densityScale, isBaked ? std::nullopt : std::optional(3.0));
  }
}

class ToneMapTest : public testing::Test {
 protected:
  /// As if an image of the state had come.
  void draw(bool emits = false, const Volume& volume = {}) {
    Scene scene{.volume = std::make_shared<const Volume>(volume), .classification = {}};
    if (emits) scene.classification.emission.emplace();
    state.latest = std::make_shared<const DrawnImage>(DrawnImage{.request = {.scene = state.scene}, .scene = scene});
    state.camera = Camera{};
    state.chooseToneMap();
  }
  /// Besides the one that is there by default.
  void addLight() {
    state.scene.lighting.lights.resize(2);
    state.scene.lighting.unlit = false;
    state.changed = true;
    state.chooseToneMap();
  }
  std::optional<ToneMap> toneMap() const { return state.scene.output.toneMap; }

  ViewState state;
};

TEST_F(ToneMapTest, IsFilmicWhereLightMayBeBrighterThanTheScreenWhichIsSaid) {
  addLight();
  EXPECT_FALSE(toneMap()) << "nothing is known before the first image";
  draw();
  EXPECT_EQ(toneMap(), ToneMap::Filmic);
  EXPECT_TRUE(state.toneMapIsAutomatic);
  EXPECT_NE(state.notice.find("filmic"), std::string::npos);
  state.notice.clear();
  draw();
  EXPECT_EQ(state.notice, "") << "said once";
  state.scene.method.mode = IntensityProjection::Maximum;
  draw();
  EXPECT_FALSE(toneMap()) << "values are shown, on which no light shines";
}

TEST_F(ToneMapTest, IsNoneWithTheLightsOfTheDefault) {
  state.scene.lighting.lights.resize(1);
  state.scene.lighting.ambient = glm::dvec3(0.2);
  draw();
  EXPECT_FALSE(toneMap()) << "colours are those of the colour bar";
  state.scene.lighting.lights.front().light.intensity = 1.5 * kDefaultIrradiance;
  draw();
  EXPECT_EQ(toneMap(), ToneMap::Filmic);
  state.scene.lighting.lights.front().light = {.atInfinity = false};
  draw();
  EXPECT_EQ(toneMap(), ToneMap::Filmic) << "a point light is brighter near it";
  state.scene.lighting.lights.resize(0);
  draw();
  EXPECT_FALSE(toneMap());
  state.scene.lighting.environment = "sky.exr";
  draw();
  EXPECT_EQ(toneMap(), ToneMap::Filmic);
}

TEST_F(ToneMapTest, IsNoneWithoutLightUnlessThereIsEmission) {
  state.scene.lighting.unlit = true;
  state.scene.classification.transferFunction = "viridis";
  draw();
  EXPECT_FALSE(toneMap());
  EXPECT_FALSE(state.toneMapIsAutomatic);
  EXPECT_EQ(state.notice, "");
  draw(true);
  EXPECT_EQ(toneMap(), ToneMap::Filmic);
  state.scene.emission.emission = false;
  state.chooseToneMap();
  EXPECT_FALSE(toneMap()) << "the image of it has not come yet";
  Volume channels;
  channels.madeOf = MadeOf::Channels;
  state.scene.emission = {};
  draw(true, channels);
  EXPECT_FALSE(toneMap()) << "they send out the colours of their values";
}

TEST_F(ToneMapTest, ThatIsGivenStays) {
  for (const ToneMap given : {ToneMap::None, ToneMap::Aces}) {
    state.scene.output.toneMap = given;
    draw();
    EXPECT_EQ(toneMap(), given);
    addLight();
    draw();
    EXPECT_EQ(toneMap(), given);
    EXPECT_FALSE(state.toneMapIsAutomatic);
    EXPECT_EQ(state.notice, "");
  }
}

TEST_F(ToneMapTest, ComesAndGoesWithTheFirstLightAndWithItsUndoing) {
  EditHistory history;
  state.scene.lighting.unlit = true;
  draw();
  history.follow(state, false, false);
  addLight();
  EXPECT_EQ(toneMap(), ToneMap::Filmic);
  history.follow(state, true, false);
  history.follow(state, false, false);
  history.undo(state);
  state.chooseToneMap();
  EXPECT_FALSE(toneMap());
  EXPECT_FALSE(history.canUndo()) << "it is no step of its own";
  history.redo(state);
  state.chooseToneMap();
  EXPECT_EQ(toneMap(), ToneMap::Filmic);
  EXPECT_TRUE(state.toneMapIsAutomatic);
  state.scene.lighting = {.unlit = true};
  state.chooseToneMap();
  EXPECT_FALSE(toneMap());
}

TEST_F(ToneMapTest, IsNotAppliedToDiagnosesUnlessItIsGiven) {
  addLight();
  draw();
  EXPECT_EQ(state.look().toneMap, ToneMap::Filmic);
  state.diagnosis.shown = Shown::Energy;
  EXPECT_EQ(state.look().toneMap, ToneMap::Filmic) << "the last image is none yet";
  DrawnImage drawn = *state.latest;
  drawn.request.diagnosis = state.diagnosis;
  state.latest = std::make_shared<const DrawnImage>(drawn);
  EXPECT_EQ(state.look().toneMap, ToneMap::None);
  EXPECT_EQ(toneMap(), ToneMap::Filmic) << "it is that of the image, which is saved";
  state.toneMapIsAutomatic = false;
  EXPECT_EQ(state.look().toneMap, ToneMap::Filmic);
}

TEST_F(EditHistoryTest, UndoAndRedoGoThroughTheStepsInOrder) {
  for (const double stops : {1.0, 2.0, 3.0}) {
    expose(stops);
    rest();
  }
  history.undo(state);
  EXPECT_EQ(exposure(), 2.0);
  EXPECT_TRUE(state.changed) << "an image of it is asked for";
  history.undo(state);
  history.undo(state);
  EXPECT_EQ(exposure(), std::nullopt);
  EXPECT_FALSE(history.canUndo());
  history.undo(state);
  EXPECT_EQ(exposure(), std::nullopt) << "there is nothing before";
  history.redo(state);
  history.redo(state);
  history.redo(state);
  EXPECT_EQ(exposure(), 3.0);
  EXPECT_FALSE(history.canRedo());
}

TEST_F(EditHistoryTest, ADragIsOneStep) {
  for (int i = 1; i <= 10; ++i) {
    expose(0.1 * i);
    history.follow(state, false, true);  // the button is held, and the mouse rests
  }
  rest();
  history.undo(state);
  EXPECT_EQ(exposure(), std::nullopt);
  EXPECT_FALSE(history.canUndo());
}

TEST_F(EditHistoryTest, AnEditAfterUndoForgetsWhatWasUndone) {
  expose(1.0);
  rest();
  history.undo(state);
  rest();
  expose(5.0);
  rest();
  EXPECT_FALSE(history.canRedo());
  history.undo(state);
  EXPECT_EQ(exposure(), std::nullopt);
}

TEST_F(EditHistoryTest, AnotherVolumeIsAStepAndTheWindowKeepsItsSize) {
  state.scene.input.volume = "procedural:cloud";
  rest();
  SceneDescription other = state.scene;
  other.input.volume = "procedural:head";
  state.show(other, std::nullopt);
  history.follow(state, true, false);
  state.camera = Camera{};  // of the first image
  rest();
  state.scene.camera.size = {640, 480};
  history.undo(state);
  EXPECT_EQ(state.scene.input.volume, "procedural:cloud");
  EXPECT_TRUE(state.camera);
  EXPECT_EQ(state.scene.camera.size, glm::ivec2(640, 480));
}

TEST_F(EditHistoryTest, TheCameraStaysWhileEditsAreUndone) {
  expose(1.0);
  rest();
  Camera turned;
  turned.position = {3.0, 2.0, 1.0};
  state.setCamera(turned);
  rest();
  history.undo(state);
  EXPECT_EQ(exposure(), std::nullopt);
  EXPECT_EQ(state.camera->position, turned.position);
  EXPECT_EQ(state.scene.camera.position, turned.position);
}

TEST(CameraHistory, GoesBackAndForwardThroughTheCamerasOfAVolume) {
  ViewState state;
  state.scene.input.volume = "procedural:cloud";
  CameraHistory cameras;
  const auto look = [&](double x) {
    Camera camera;
    camera.position = {x, 0.0, 1.0};
    state.setCamera(camera);
    cameras.follow(state, true, true);
    cameras.follow(state, false, false);
  };
  state.camera = Camera{};
  cameras.follow(state, false, false);
  look(1.0);
  look(2.0);
  cameras.goBack(state);
  EXPECT_EQ(state.camera->position.x, 1.0);
  EXPECT_TRUE(state.moved);
  cameras.goBack(state);
  EXPECT_EQ(state.camera->position.x, 0.0);
  EXPECT_FALSE(cameras.canGoBack());
  cameras.goForward(state);
  EXPECT_EQ(state.camera->position.x, 1.0);
  state.scene.input.volume = "procedural:head";
  cameras.follow(state, false, false);
  EXPECT_FALSE(cameras.canGoBack()) << "of another volume";
}

TEST_F(EditHistoryTest, WhatIsChosenForTheFirstImageIsNoEdit) {
  EditHistory fresh;
  ViewState opened;
  fresh.follow(opened, true, false);
  opened.camera = Camera{};
  fresh.follow(opened, false, false);
  EXPECT_FALSE(fresh.canUndo());
}

}  // namespace
}  // namespace freevoxels
