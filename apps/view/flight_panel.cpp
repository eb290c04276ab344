#include "apps/view/flight_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <utility>

#include "apps/common/failure.h"
#include "apps/view/widgets.h"
#include "engine/core/atomic_file.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr double kBetweenKeys = 2.0;  // seconds after the last key at which another is added
constexpr double kLongestTime = 1e6;  // seconds

/// Shows the flight at a time.
void showFlight(ViewState& state, double time) {
  if (!state.latest) return;
  try {
    const Flight flight = state.flight.resolve(*state.latest->scene.volume);
    state.setCamera(flight.cameraAt(time));
    const std::vector<Light> lights = flight.lightsAt(time);
    if (lights.empty()) return;
    LightingDescription lighting = state.scene.lighting;
    lighting.take(lights);
    if (lighting == state.scene.lighting) return;
    state.scene.lighting = std::move(lighting);
    state.changed = true;
  } catch (const Error& error) {
    state.problem = withOptions(error);
  }
}

/// Changes the time of a key. Times that are not between those of its neighbours are not taken.
bool editTime(std::vector<FlightKeyDescription>& keys, std::size_t i) {
  double time = keys[i].time;
  if (!ImGui::InputDouble("##time", &time, 0.0, 0.0, "%.2f s")) return false;
  const bool isBehind = time > (i > 0 ? keys[i - 1].time : -kLongestTime);
  if (!isBehind || !(time < (i + 1 < keys.size() ? keys[i + 1].time : kLongestTime))) return false;
  keys[i].time = time;
  return true;
}

}  // namespace

std::optional<std::string> flightOf(const Edits& edits) {
  if (edits.flight.keys.size() < kMinFlightKeys) return std::nullopt;
  return flightText(edits.flight);
}

FlightKeyDescription FlightPanel::keyOf(const ViewState& state) const {
  FlightKeyDescription key;
  key.camera.look(*state.camera);
  if (keepsLights_ && !state.scene.lighting.unlit) key.lights = state.scene.lighting.lights;
  return key;
}

void FlightPanel::drawKeys(ViewState& state) {
  std::vector<FlightKeyDescription>& keys = state.flight.keys;
  const ImGuiStyle& style = ImGui::GetStyle();
  const auto widthOf = [&](const char* text) { return ImGui::CalcTextSize(text).x + 2.0f * style.FramePadding.x; };
  std::optional<std::size_t> removed;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    ImGui::PushID(int(i));
    if (ImGui::Button(fmt::format("Key {}", i + 1).c_str(), {widthOf("Key 10000"), 0.0f})) showFlight(state, time_ = keys[i].time);
    hint("Shows this key of the flight");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-widthOf("set") - widthOf("x") - 2.0f * style.ItemSpacing.x);
    state.retoned |= editTime(keys, i);
    hint("Seconds at which the flight passes this key, between those of its neighbours");
    ImGui::SameLine();
    if (ImGui::Button("set")) {
      const double time = keys[i].time;
      keys[i] = keyOf(state);
      keys[i].time = time;
      state.retoned = true;
    }
    hint("Gives this key the camera of now");
    ImGui::SameLine();
    if (ImGui::Button("x")) removed = i;
    hint("Removes this key");
    ImGui::PopID();
  }
  if (!removed) return;
  keys.erase(keys.begin() + std::ptrdiff_t(*removed));
  state.retoned = true;
}

void FlightPanel::drawPlayer(ViewState& state) {
  const std::vector<FlightKeyDescription>& keys = state.flight.keys;
  if (ImGui::Button(plays_ ? "Pause flight###play" : "Play flight###play", {-1.0f, 0.0f})) plays_ = !plays_;
  hint("Moves the camera through the keys, again and again; Export writes the frames");
  if (ImGui::Button("Save keys...", {-1.0f, 0.0f}))
    dialog_.save("Save the keys of the flight", name_, {".json"}, [this, text = flightText(state.flight)](const std::string& file) {
      name_ = file;
      try {
        writeTextAtomically(file, text + "\n");
        outcome_ = "saved " + file;
      } catch (const Error& error) {
        outcome_ = withOptions(error);
      }
    });
  hint("Writes the keys, which Open reads again (Ctrl+O)", "--flight");
  if (!slide("Time", time_, keys.front().time, keys.back().time, "%.2f s")) return;
  plays_ = false;
  showFlight(state, time_);
}

void FlightPanel::draw(ViewState& state) {
  if (!ImGui::TreeNode("Flight")) return;
  drawKeys(state);
  if (ImGui::Button("Add key", {-1.0f, 0.0f})) {
    std::vector<FlightKeyDescription>& keys = state.flight.keys;
    const double time = keys.empty() ? 0.0 : keys.back().time + kBetweenKeys;
    keys.push_back(keyOf(state));
    keys.back().time = time_ = time;
    state.retoned = true;
  }
  hint("The camera of now, behind the last key", "--flight");
  tick("Keys move lights", keepsLights_);
  hint("Keys that are added or set also have the lights of now");
  if (state.flight.keys.size() >= kMinFlightKeys) drawPlayer(state);
  ImGui::TreePop();
}

void FlightPanel::follow(ViewState& state, double seconds) {
  if (!outcome_.empty()) state.notice = std::exchange(outcome_, "");
  const std::vector<FlightKeyDescription>& keys = state.flight.keys;
  if (!state.camera || keys.size() < kMinFlightKeys) plays_ = false;
  if (!plays_) return;
  time_ += seconds;
  if (time_ < keys.front().time || time_ > keys.back().time) time_ = keys.front().time;
  showFlight(state, time_);
}

}  // namespace freevoxels
