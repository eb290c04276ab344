#include "apps/view/channel_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/view/widgets.h"
#include "engine/core/error.h"
#include "engine/description/label_words.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

bool drawFunction(ChannelStyle& style) {
  std::string function = style.function;
  if (!editText("Function", function, "none; a preset or a file")) return false;
  style.function = function.empty() || presetNamed(function) != nullptr ? function : meantFile(function);
  return true;
}

bool drawWindow(ViewState& state, ChannelStyle& style) {
  std::string text = style.window ? fmt::format("{},{}", (*style.window)[0], (*style.window)[1]) : std::string();
  const bool changed = editText("Window", text, "LO,HI; chosen of the values");
  hint("Values at which the intensity is 0 and 1", "--channel NAME:LO,HI");
  if (changed) attempt(state, [&] { style.window = text.empty() ? std::nullopt : readChannel("window", "0:" + text).window; });
  return changed;
}

bool drawWeight(ChannelStyle& style) {
  constexpr double kLeast = 0.01, kMost = 100.0;
  double weight = double(style.weight);
  if (!slideLogarithmic("Weight", weight, kLeast, kMost)) return false;
  hint("Factor of its density, or of its light", "--channel NAME@WEIGHT");
  style.weight = float(weight);
  return true;
}

}  // namespace

/// Takes the channels of the scene where something else has changed them, and those that a file shows by itself. Colours are given, so that
/// they stay when another channel is hidden.
void ChannelPanel::follow(const ViewState& state) {
  const std::string& file = state.scene.input.volume;
  const bool isDrawn = state.latest && state.latest->request.scene.input.volume == file;
  const std::vector<ChannelStyle>& given = state.scene.classification.channels;
  const bool isMade = isDrawn && state.latest->scene.volume->madeOf == MadeOf::Channels;
  const bool isMissing = given.empty() && isMade && entries_.empty();
  if (volume_ == file && given == given_ && !isMissing) return;
  volume_ = file;
  given_ = given;
  entries_.clear();
  for (const ChannelStyle& style : given.empty() && isMade ? state.latest->channels : given) {
    entries_.push_back({style});
    entries_.back().item.color = channelColor(style, entries_.size() - 1);
  }
}

bool ChannelPanel::drawEntry(ViewState& state, std::size_t index, bool& isRemoved) {
  WithEye<ChannelStyle>& entry = entries_[index];
  ImGui::PushID(int(index));
  bool changed = checkBox("##shown", &entry.isShown);
  hint("Whether the channel is drawn");
  ImGui::SameLine();
  glm::dvec3 color(channelColor(entry.item, index));
  if (editSwatch("##color", color)) {
    entry.item.color = glm::vec3(color);
    changed = true;
  }
  ImGui::SameLine();
  if (ImGui::TreeNode("channel", "%s", entry.item.name.c_str())) {
    changed |= drawFunction(entry.item);
    changed |= drawWindow(state, entry.item);
    changed |= drawWeight(entry.item);
    changed |= tick("Emission", entry.item.emits);
    hint("It sends out light, and dims nothing", "--channel NAME:emission");
    if (ImGui::Button("Remove", {-1.0f, 0.0f})) isRemoved = changed = true;
    ImGui::TreePop();
  }
  ImGui::PopID();
  return changed;
}

bool ChannelPanel::drawAdding(ViewState& state) {
  const bool isTyped = editText("Add channel", typed_, "a grid's name or number");
  hint("Draws several grids, or channels of a scan, with a colour each", "--channel");
  if (!isTyped || typed_.empty()) return false;
  bool isAdded = false;
  attempt(state, [&] {
    entries_.push_back({readChannel("channel", typed_)});
    entries_.back().item.color = channelColor(entries_.back().item, entries_.size() - 1);
    typed_.clear();
    isAdded = true;
  });
  return isAdded;
}

void ChannelPanel::draw(ViewState& state, std::size_t grids) {
  follow(state);
  if (entries_.empty() && grids < 2) return;
  if (!entries_.empty()) heading("Channels");
  bool changed = false;
  std::optional<std::size_t> removed;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    bool isRemoved = false;
    changed |= drawEntry(state, i, isRemoved);
    if (isRemoved) removed = i;
  }
  if (removed) entries_.erase(entries_.begin() + std::ptrdiff_t(*removed));
  changed |= drawAdding(state);
  if (!changed) return;
  ClassificationDescription& look = state.scene.classification;
  const bool hadNone = look.channels.empty();
  if (shownOf(entries_).empty()) return;  // a volume without any would be drawn as a grid
  look.channels = given_ = shownOf(entries_);
  if (hadNone) look.transferFunction.reset(), look.window.reset(), look.densityScale.reset();
  state.changed = true;
}

}  // namespace freevoxels
