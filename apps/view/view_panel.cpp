#include "apps/view/view_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <string>
#include <vector>

#include "apps/view/navigation.h"
#include "apps/view/widgets.h"

namespace freevoxels {

namespace {

struct NamedBackground {
  const char* name;
  glm::dvec3 color;  ///< linear
};
constexpr std::array kPlainBackgrounds{NamedBackground{"black", glm::dvec3(0.0)}, NamedBackground{"grey", glm::dvec3(0.2)},
                                       NamedBackground{"white", glm::dvec3(1.0)},
                                       NamedBackground{"blue-grey", glm::dvec3(0.085, 0.1, 0.16)}};

void drawCamera(ViewState& state) {
  Camera camera = *state.camera;
  bool moved = false;
  const auto vector = [&](const char* name, glm::dvec3& value, const char* meaning, const char* option) {
    moved |= ImGui::InputScalarN(beginRow(name), ImGuiDataType_Double, &value.x, 3, nullptr, nullptr, "%.3g");
    hint(meaning, option);
  };
  vector("Eye", camera.position, "Position of the camera, world units", "--camera-position");
  vector("Look-at point", camera.lookAt, "Point in the middle of the image, about which a drag turns; world units", "--look-at");
  vector("Up", camera.up, "Direction that is upright in the image", "--up");
  int projection = camera.orthographic ? 1 : 0;
  if (choose("Projection", {"perspective", "orthographic"}, projection)) return state.setCamera(withOtherProjection(camera));
  hint("O switches it", "--orthographic");
  if (camera.orthographic)
    moved |=
        slideLogarithmic("Height", camera.orthographicHeight, 0.01 * camera.orthographicHeight, 100.0 * camera.orthographicHeight, "%.4g");
  else
    moved |= slide("Field of view", camera.verticalFov, 5.0, 120.0, "%.0f°");
  hint("Of the image's height", camera.orthographic ? "--orthographic" : "--fov");
  if (moved) state.setCamera(camera);
}

void drawBookmarks(ViewState& state, SessionStore& store) {
  heading("Camera bookmarks");
  std::optional<std::size_t> removed;
  for (std::size_t i = 0; i < state.bookmarks.size(); ++i) {
    ImGui::PushID(int(i));
    const float remove = ImGui::CalcTextSize("x").x + 2.0f * ImGui::GetStyle().FramePadding.x;
    if (ImGui::Button(fmt::format("View {}", i + 1).c_str(), {-remove - ImGui::GetStyle().ItemSpacing.x, 0.0f}))
      state.setCamera(state.bookmarks[i]);
    ImGui::SameLine();
    if (ImGui::Button("x")) removed = i;
    hint("Removes this bookmark");
    ImGui::PopID();
  }
  if (removed) {
    state.bookmarks.erase(state.bookmarks.begin() + std::ptrdiff_t(*removed));
    store.setBookmarks(state.scene.input.volume, state.bookmarks);
  }
  if (ImGui::Button("Add bookmark", {-1.0f, 0.0f})) addBookmark(state, store);
  hint("Keeps this camera for this volume, in later sessions, too (Ctrl+B)");
}

/// These only affect how an image is shown and written: it is not drawn again.
void drawBackground(ViewState& state) {
  OutputDescription& output = state.scene.output;
  std::vector<std::string> words{"dark gradient", "transparent"};
  for (const NamedBackground& plain : kPlainBackgrounds) words.emplace_back(plain.name);
  words.emplace_back("own colour");
  int chosen = output.transparent ? 1 : !output.background ? 0 : int(words.size()) - 1;
  for (std::size_t i = 0; i < kPlainBackgrounds.size(); ++i)
    if (output.background == kPlainBackgrounds[i].color) chosen = 2 + int(i);
  if (choose("Background", words, chosen)) {
    output.transparent = chosen == 1;
    if (chosen < 2)
      output.background.reset();
    else if (chosen < 2 + int(kPlainBackgrounds.size()))
      output.background = kPlainBackgrounds[std::size_t(chosen - 2)].color;
    else
      output.background = glm::dvec3(0.3, 0.4, 0.5);
    state.retoned = true;
  }
  hint("What is behind the volume", output.transparent ? "--transparent" : "--background");
  if (output.background) state.retoned |= editColor("Colour", *output.background);
  state.retoned |= slideOptional("Exposure", output.exposure, 0.0, -8.0, 8.0, "%.1f EV");
  hint("Stops by which the image is brightened", "--exposure");
  int toneMap = int(output.toneMap.value_or(ToneMap::None)) - kToneMapWords.first;
  if (choose("Tone map", kToneMapWords.texts, toneMap)) {
    output.toneMap = kToneMapWords.at(toneMap);  // none as well, so that light that comes later changes nothing
    state.toneMapIsAutomatic = false;
    state.retoned = true;
  }
  std::string meaning = "Curve that maps bright light into the range of the screen";
  if (state.toneMapIsAutomatic) meaning += ": filmic, as the light may be brighter than the screen; choose none for linear values";
  hint(meaning.c_str(), "--tone-map");
}

}  // namespace

void addBookmark(ViewState& state, SessionStore& store) {
  if (!state.camera) return;
  state.bookmarks.push_back(*state.camera);
  store.setBookmarks(state.scene.input.volume, state.bookmarks);
  state.notice = fmt::format("added the camera as View {}", state.bookmarks.size());
}

void drawViewPanel(ViewState& state, SessionStore& store, FlightPanel& flight) {
  if (!panelHeader("View", state.camera.has_value(), true)) return;
  ImGui::PushID("view");
  drawBackground(state);
  if (ImGui::TreeNode("Camera")) {
    drawCamera(state);
    drawBookmarks(state, store);
    ImGui::TreePop();
  }
  flight.draw(state);
  ImGui::PopID();
}

}  // namespace freevoxels
