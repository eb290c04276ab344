// Scene descriptions as JSON and back, and what is refused.

#include "engine/description/scene_json.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels::test {

namespace {

/// Gives every field that is not in others() a value other than its default. Names of grids may look like numbers.
SceneDescription everything(const TemporaryFolder& folder) {
  SceneDescription scene;
  scene.input = {.volume = "procedural:cloud",
                 .grid = "density[1]",
                 .resolution = glm::ivec3(20, 30, 40),
                 .clipBox = VoxelBox{{1, 2, 3}, {4, 5, 6}},
                 .clipPlane = ClipPlane{{0.5, -1.0, 2.0}, {0.0, 1e-3, 1.0}},
                 .noData = NoData{.value = -1024.5}};
  scene.classification = {.densityScale = 1.0 / 3.0,
                          .albedo = glm::dvec3(0.1, 0.2, 0.3),
                          .albedoGrid = "26",
                          .order = ClassificationOrder::Pre};
  scene.emission = {.emission = true, .strength = 0.1, .temperatureGrid = "98", .temperatureScale = 1e-7, .temperatureOffset = -5.0};
  scene.camera = {.position = glm::dvec3(1e9, -2.5, 1.0 / 7.0),
                  .lookAt = glm::dvec3(0.0),
                  .up = glm::dvec3(0.0, 0.0, 1.0),
                  .verticalFov = 33.3,
                  .size = {640, 480},
                  .frames = 7};
  scene.lighting = {.lights = {{.light = {.place = {1.0, 2.0, 3.0}, .color = {0.1, 1.0, 2.0}, .intensity = 7.5}, .hasIntensity = true},
                               {.light = {.place = {-1.0, 0.0, 0.1}, .atInfinity = false}}},
                    .ambient = glm::dvec3(0.1, 0.2, 0.3),
                    .environment = (folder / "sky.exr").string(),
                    .environmentRotation = 12.5,
                    .environmentIntensity = 0.5,
                    .tint = glm::dvec3(0.2, 5.0, 1.0),
                    .phaseG = -0.5,
                    .scattering = 4,
                    .attenuation = LightAttenuation::Exact,
                    .shading = Shading::Gradient,
                    .surface = 0.75,
                    .unlit = true};
  scene.method = {.paper = true,
                  .draw = Draw::Splats,
                  .composite = Composite::Sorted,
                  .attenuation = AttenuationLookup::Nearest,
                  .directions = DirectionSet::Directions98,
                  .code = AttenuationCode::Linear8,
                  .pathLengthCorrection = false,
                  .gradient = true,
                  .lod = 0.0,
                  .quality = 0.5,
                  .culling = false,
                  .cullThreshold = 0.001,
                  .hierarchyFilter = HierarchyFilter::Arithmetic};
  scene.output = {.background = glm::dvec3(0.0, 0.5, 1.0),
                  .exposure = -1.5,
                  .toneMap = ToneMap::Filmic,
                  .fullFloat = true,
                  .pngBits = PngBits::Sixteen,
                  .aovs = {.depth = true, .normal = true},
                  .crop = PixelRectangle{{1, 2}, {3, 4}}};
  return scene;
}

/// The fields that exclude some of everything().
SceneDescription others(const TemporaryFolder& folder) {
  SceneDescription scene;
  scene.input.volume = (folder / "a.vdb").string();
  scene.input.noData = NoData{};
  scene.input.raw = RawLayout{.dimensions = {4, 5, 6}, .type = SampleType::I16, .isBigEndian = true, .headerBytes = 12};
  scene.input.series = "1.2.840.5";
  scene.input.timeStep = 3;
  scene.input.spacing = glm::dvec3(0.5, 0.25, 3.0);
  scene.input.pyramidLevel = 2;
  scene.camera.holdout = (folder / "depth.exr").string();
  scene.classification.transferFunction = R"({"opacity":[[0,0],[1,0.5]]})";
  scene.classification.window = ValueWindow{-160.0, 240.1};
  scene.classification.opacity = 0.3;
  scene.classification.invert = true;
  scene.emission.emission = true;
  scene.camera.orbit = glm::dvec2(10.0, -20.0);
  scene.camera.orthographicHeight = 2.5;
  scene.output.transparent = true;
  AddedVolume added{.shading = Shading::Scatter, .transform = glm::dmat4(1.0)};
  added.input = {.volume = (folder / "b.vdb").string(), .grid = "soot"};
  added.classification.transferFunction = (folder / "f.json").string();
  added.emission.emission = false;
  (*added.transform)[3] = {0.1, 2.0, 1e-7, 1.0};
  scene.added = {added, AddedVolume{.input = {.volume = "procedural:fire", .resolution = glm::ivec3(9)},
                                    .classification = {.transferFunction = "ct-bone"}}};
  return scene;
}

/// The fields that exclude some of both.
SceneDescription labelled() {
  SceneDescription scene;
  scene.classification.labels = Labels{.showsAll = true, .styles = {{-3, {.opacity = 0.5f}}, {7, {.color = glm::vec3(1, 0, 0)}}}};
  return scene;
}
SceneDescription dyed(const TemporaryFolder& folder) {
  SceneDescription scene;
  scene.classification.channels = {{.name = "0"},
                                   {.name = "1", .function = (folder / "f.json").string()},
                                   {.name = "ct", .function = "ct-bone"},
                                   {.name = "gfp", .weight = 2.5f, .window = std::array{0.25f, 4000.0f}, .emits = true}};
  return scene;
}

SceneDescription surface() {
  SceneDescription scene;
  scene.classification.iso = IsoSurface{.value = -0.25, .color = {0.5, 0.25, 1.0}};
  scene.method.mode = IntensityProjection::Average;
  return scene;
}

SceneDescription slice() {
  SceneDescription scene;
  scene.method.slice = SlicePlane{.axis = 1, .position = 12.5, .isPercent = true};
  scene.method.annotate = true;
  return scene;
}

SceneDescription flight(const TemporaryFolder& folder) {
  SceneDescription scene;
  scene.camera.flight = (folder / "flight.json").string();
  return scene;
}

nlohmann::json jsonIn(const std::filesystem::path& file) {
  return nlohmann::json::parse(readBytes(file));
}

}  // namespace

TEST(SceneJson, DescriptionsSurviveTheWayToAFileAndBack) {
  const TemporaryFolder folder;
  for (const SceneDescription& scene :
       {everything(folder), others(folder), labelled(), dyed(folder), surface(), slice(), flight(folder), SceneDescription{}}) {
    writeScene(folder / "s.json", scene);
    EXPECT_EQ(readScene(folder / "s.json"), scene) << readBytes(folder / "s.json");
  }
}

TEST(SceneJson, FormerWordsOfTheMethodAreThoseOfNothingGiven) {
  const TemporaryFolder folder;
  writeBytes(folder / "s.json", R"({"method": {"draw": "auto", "attenuation": "exact", "lod": 2}})");
  EXPECT_EQ(readScene(folder / "s.json").method, MethodDescription{.lod = 2.0});
}

TEST(SceneJson, ASliceIsATextOrAPair) {
  const TemporaryFolder folder;
  for (const char* const given : {R"("z:-12.5")", R"(["z", -12.5])", R"(["z", "-12.5"])"}) {
    writeBytes(folder / "s.json", fmt::format(R"({{"method": {{"slice": {}}}}})", given));
    EXPECT_EQ(readScene(folder / "s.json").method.slice, (SlicePlane{.axis = 2, .position = -12.5})) << given;
  }
  for (const char* const wrong :
       {R"("w:1")", R"("z")", R"("z:")", R"("z:1,2")", R"("z:%")", R"("z:nan")", R"(["z"])", R"(["z", 1, 2])", "3"}) {
    writeBytes(folder / "s.json", fmt::format(R"({{"method": {{"slice": {}}}}})", wrong));
    const std::string sentence = errorOf([&] { readScene(folder / "s.json"); }).what();
    EXPECT_NE(sentence.find("AXIS:POSITION"), std::string::npos) << wrong << ": " << sentence;
  }
}

TEST(SceneJson, AKeyWithoutEffectOfAnEarlierVersionIsReadWithOneSentence) {
  const TemporaryFolder folder;
  writeBytes(folder / "s.json", R"({"light": {"scattering": 3, "scattering-scale": 0.4}})");
  EXPECT_EQ(readScene(folder / "s.json").lighting.scattering, 3);
  const std::vector<std::string> warnings = SceneFile(folder / "s.json").warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings.front().find("scattering-scale"), std::string::npos) << warnings.front();
  writeBytes(folder / "t.json", R"({"light": {"scattering": "all"}})");
  EXPECT_EQ(readScene(folder / "t.json").lighting.scattering, kAllOrders);
  EXPECT_TRUE(SceneFile(folder / "t.json").warnings().empty());
}

TEST(SceneJson, TheTestsAboveHaveEveryField) {
  const TemporaryFolder folder;
  const std::array scenes{everything(folder), others(folder), labelled(), dyed(folder), surface(), slice(), flight(folder)};
  for (const SceneField& field : sceneFields())
    EXPECT_TRUE(std::ranges::any_of(scenes, [&](const SceneDescription& scene) { return !field.texts(scene).empty(); }))
        << field.section << "." << field.name;
}

TEST(SceneJson, FileNamesAreRelativeToTheFile) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "scenes");
  writeScene(folder / "scenes/s.json", everything(folder));
  EXPECT_EQ(jsonIn(folder / "scenes/s.json").at("light").at("environment"), "../sky.exr");
  EXPECT_EQ(jsonIn(folder / "scenes/s.json").at("input").at("volume"), "procedural:cloud");
  EXPECT_EQ(readScene(folder / "scenes/s.json").lighting.environment, (folder / "sky.exr").string());
  EXPECT_EQ(sceneToJson(everything(folder), std::nullopt).at("light").at("environment"), (folder / "sky.exr").string());
}

TEST(SceneJson, ValuesMayBeTextsAsOnTheCommandLine) {
  const TemporaryFolder folder;
  writeBytes(folder / "s.json", R"({"camera": {"size": "640x420", "up": "0,0,1"}, "classification": {"albedo": "white"},
      "light": {"lights": ["direction=1,0,0,intensity=2"], "ambient": 0.5}, "emission": {"emission": false}})");
  const SceneDescription scene = readScene(folder / "s.json");
  EXPECT_EQ(scene.camera.size, glm::ivec2(640, 420));
  EXPECT_EQ(scene.camera.up, glm::dvec3(0.0, 0.0, 1.0));
  EXPECT_EQ(scene.classification.albedo, glm::dvec3(1.0));
  ASSERT_EQ(scene.lighting.lights.size(), 1u);
  EXPECT_EQ(scene.lighting.lights[0].light.intensity, 2.0);
  EXPECT_EQ(scene.lighting.ambient, glm::dvec3(0.5));
  EXPECT_EQ(scene.emission.emission, false);
}

TEST(SceneJson, WrongFilesAreRefusedByFileAndKey) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& json, const std::string& part) {
    SCOPED_TRACE(json);
    writeBytes(folder / "s.json", json);
    expectRefusal([&] { readScene(folder / "s.json"); }, ErrorKind::Input, {(folder / "s.json").string(), part});
  };
  expect("[]", "must be an object");
  expect(R"({"camera": 5})", R"("camera" takes an object of keys, not 5)");
  expect(R"({"camra": {}})", R"(there is no key "camra"; did you mean "camera"?)");
  expect(R"({"camera": {"fob": 3}})", R"(there is no key "camera.fob"; did you mean "camera.fov"?)");
  expect(R"({"light": {"fov": 3}})", R"(there is no key "light.fov"; did you mean "camera.fov"?)");
  expect(R"({"camera": {"fov": true}})", R"("camera.fov" takes DEG, not true)");
  expect(R"({"camera": {"fov": "wide"}})", "fov takes DEG, a finite number, not 'wide'");
  expect(R"({"camera": {"up": [0, null, 1]}})", R"("camera.up" takes X,Y,Z, not [0,null,1])");
  expect(R"({"camera": {"orbit": [1, 2], "camera-position": [1, 2, 3]}})", R"("camera.orbit" and "camera.camera-position" exclude each other)");
  expect(R"({"method": {"culling": "no"}})", R"("method.culling" takes true or false, not "no")");
  expect(R"({"method": {"draw": "sketch"}})", "draw takes 'gather' or 'splats', not 'sketch'");
  expect(R"({"light": {"lights": {"direction": [1, 0, 0]}}})", R"("light.lights" takes a list)");
  expect(R"({"light": {"lights": [{"direction": [0, 0, 0]}]}})", "points nowhere");
  expect(R"({"output": {"aov": "z"}})", "aov takes depth, position, normal, transmittance, lights and channels");
}

TEST(SceneJson, DeepNestingIsRefused) {
  const TemporaryFolder folder;
  for (const int depth : {65, 1000, 1000000})
    for (const bool isComplete : {true, false}) {
      const std::string deep = std::string(std::size_t(depth), '[') + (isComplete ? std::string(std::size_t(depth), ']') : "");
      writeBytes(folder / "s.json", R"({"camera": {"orbit": )" + deep + "}}");
      expectRefusal([&] { readScene(folder / "s.json"); }, ErrorKind::Input, {(folder / "s.json").string(), "nested more than 64 deep"});
    }
}

TEST(SceneJson, AFieldOfAStrongerSourceReplacesWhatItExcludesAndStandsFor) {
  const auto replaces = [](const char* stronger, const char* field) {
    return isReplaced(sceneField(field), {&sceneField(stronger)});
  };
  EXPECT_TRUE(replaces("fov", "fov"));
  EXPECT_TRUE(replaces("fov", "orthographic"));
  EXPECT_TRUE(replaces("orthographic", "fov"));
  EXPECT_TRUE(replaces("volume", "clip-box"));
  EXPECT_FALSE(replaces("clip-box", "volume"));
  EXPECT_TRUE(replaces("paper", "lod"));
  EXPECT_FALSE(replaces("lod", "paper"));
  EXPECT_FALSE(replaces("up", "fov"));
}

TEST(SceneDescription, WhatWasResolvedComesToTheSameAgain) {
  SceneDescription scene;
  scene.input = {.volume = "procedural:cloud", .resolution = glm::ivec3(16)};
  scene.lighting.lights = {{.light = {.place = {1.0, 2.0, 3.0}, .atInfinity = false}}};
  const auto volume = std::make_shared<const Volume>(scene.readVolume(1u << 20));
  const Scene first = scene.resolve(volume);
  const SceneDescription resolved = scene.resolved(first);
  const Scene again = resolved.resolve(volume);
  EXPECT_EQ(again.camera.position, first.camera.position);
  EXPECT_EQ(again.camera.lookAt, first.camera.lookAt);
  EXPECT_EQ(again.lighting, first.lighting);
  EXPECT_EQ(again.classification.densityScale, first.classification.densityScale);
  EXPECT_EQ(again.classification.albedo, first.classification.albedo);
  EXPECT_EQ(resolved.resolved(again), resolved);
  EXPECT_EQ(rendererText(resolved, again), rendererText(scene, first));
}

TEST(SceneDescription, AFunctionOfTheVolumesValuesIsResolvedWithTheirRange) {
  SceneDescription scene;
  scene.input = {.volume = "procedural:head", .resolution = glm::ivec3(16)};
  scene.classification.transferFunction = "viridis";
  const auto volume = std::make_shared<const Volume>(scene.readVolume(1u << 20));
  const Scene first = scene.resolve(volume);
  const SceneDescription resolved = scene.resolved(first);
  ASSERT_TRUE(resolved.classification.window.has_value());
  EXPECT_EQ(float(resolved.classification.window->low), first.classification.transferFunction->opacity.front().scalar);
  EXPECT_EQ(float(resolved.classification.window->high), first.classification.transferFunction->opacity.back().scalar);
  EXPECT_EQ(transferFunctionJson(*resolved.resolve(volume).classification.transferFunction),
            transferFunctionJson(*first.classification.transferFunction));
  EXPECT_EQ(rendererText(resolved, resolved.resolve(volume)), rendererText(scene, first));
  scene.classification.transferFunction = "ct-bone";
  EXPECT_FALSE(scene.resolved(scene.resolve(volume)).classification.window.has_value()) << "of values of its own";
}

TEST(SceneDescription, ATurnKeepsItsOrbitInPlaceOfTheFirstFramesPosition) {
  SceneDescription scene;
  scene.input = {.volume = "procedural:cloud", .resolution = glm::ivec3(16)};
  const auto volume = std::make_shared<const Volume>(scene.readVolume(1u << 20));
  const SceneDescription turn = scene.resolvedTurn(scene.resolve(volume), 5);
  EXPECT_FALSE(turn.camera.position || turn.camera.lookAt);
  EXPECT_EQ(turn.camera.orbit, glm::dvec2(kDefaultAzimuth, kDefaultElevation));
  EXPECT_EQ(turn.camera.frames, 5);
  scene.camera.position = glm::dvec3(1.0, 2.0, 3.0);
  EXPECT_EQ(scene.resolvedTurn(scene.resolve(volume), 5).camera.position, scene.camera.position);
}

TEST(SceneDescription, FieldsThatSayNothingAreRefusedByTheirParameters) {
  const auto expect = [](const std::vector<std::string>& parameters, const auto& change) {
    SceneDescription scene;
    scene.input.volume = "procedural:cloud";
    change(scene);
    const Error error = errorOf([&] { scene.check(); });
    EXPECT_EQ(error.kind(), ErrorKind::Usage) << error.what();
    EXPECT_EQ(error.parameters(), parameters) << error.what();
  };
  expect({"grid"}, [](SceneDescription& scene) { scene.input.grid = "a"; });
  expect({"albedo-grid"}, [](SceneDescription& scene) { scene.classification.albedoGrid = "a"; });
  expect({"clip-box"}, [](SceneDescription& scene) { scene.input.clipBox = VoxelBox{{2, 0, 0}, {1, 1, 1}}; });
  expect({"temperature-scale", "emission"}, [](SceneDescription& scene) { scene.emission = {.emission = false, .temperatureScale = 2.0}; });
  expect({"environment-rotation", "environment"}, [](SceneDescription& scene) { scene.lighting.environmentRotation = 2.0; });
  expect({"surface-share", "shading"}, [](SceneDescription& scene) {
    scene.lighting.surface = 0.5;
    scene.lighting.shading = Shading::Scatter;
  });
}

}  // namespace freevoxels::test
