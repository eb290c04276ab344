#pragma once
// A display of the tests' own, on which freevoxels-view is used as a person uses it.

#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/image/image.h"
#include "tests/commands/viewer_runner.h"

namespace freevoxels::test {

// Pixels of the window that are not the image's: at its left, and above and below it.
inline constexpr int kPanel = 340, kBar = 21;
// Those of the image that have something drawn over them: the axes at the lower left, the scale bar at the lower right.
inline constexpr glm::ivec2 kAxes{100, 100}, kScaleBar{240, 60};
inline constexpr glm::ivec2 kWindow{1280, 800};

class Viewer : public CommandTest {
 protected:
  void SetUp() override {
    if (!installedProgram("Xvfb") || !installedProgram("xdotool"))
      GTEST_SKIP() << "Xvfb and xdotool are not installed: no window can be opened and used here";
    setenv("XDG_STATE_HOME", folder.path().c_str(), 1);
    display.emplace();
  }
  ProgramResult view(const std::string& text) const { return runProgramFile(FREEVOXELS_VIEW_PROGRAM, words(text)); }
  std::unique_ptr<ViewerSession> use(const std::string& text) const { return std::make_unique<ViewerSession>(folder.path(), words(text)); }
  static void expectQuietEnd(ViewerSession& session) {
    const ProgramResult result = session.quit();
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.err, "");
  }
  static nlohmann::json sceneOf(const ViewerSession& session, const std::string& name) {
    return nlohmann::json::parse(session.save('e', name));
  }
  static glm::dvec3 vectorOf(const nlohmann::json& scene, const char* key) {
    const auto& value = scene.at("camera").at(key);
    return {value.at(0), value.at(1), value.at(2)};
  }
  static glm::dvec3 armOf(const nlohmann::json& scene) { return vectorOf(scene, "camera-position") - vectorOf(scene, "look-at"); }

  std::optional<Display> display;
};

/// Whether something is drawn over a pixel of an image of `size` pixels.
inline bool isCovered(glm::ivec2 pixel, glm::ivec2 size) {
  const glm::ivec2 fromRight = size - pixel;
  return (pixel.x < kAxes.x && fromRight.y <= kAxes.y) || (fromRight.x <= kScaleBar.x && fromRight.y <= kScaleBar.y);
}

}  // namespace freevoxels::test
