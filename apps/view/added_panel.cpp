#include "apps/view/added_panel.h"

#include <imgui.h>

#include <filesystem>
#include <optional>

#include "apps/view/widgets.h"
#include "engine/core/error.h"
#include "engine/description/added_volume.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

constexpr double kFarthestDensity = 1e4;  // factor from 1, either way

/// Where the volume is, as far as numbers of a panel say it: its offset from where its file has it.
bool drawOffset(AddedVolume& volume, double step) {
  glm::dvec3 offset = volume.transform ? glm::dvec3((*volume.transform)[3]) : glm::dvec3(0.0);
  if (!dragVector("Offset", offset, step)) return false;
  if (!volume.transform) volume.transform = glm::dmat4(1.0);
  (*volume.transform)[3] = glm::dvec4(offset, 1.0);
  return true;
}

bool drawLook(AddedVolume& volume) {
  ClassificationDescription& look = volume.classification;
  std::string function = look.transferFunction.value_or("");
  bool changed = false;
  if (editText("Transfer function", function, "none; a preset or a file")) {
    look.transferFunction =
        function.empty() ? std::nullopt : std::optional(presetNamed(function) != nullptr ? function : meantFile(function));
    if (look.transferFunction) look.densityScale.reset(), look.albedo.reset();
    changed = true;
  }
  if (look.transferFunction) return changed;
  double density = look.densityScale.value_or(1.0);
  if (slideLogarithmic(look.densityScale ? "Density" : "Density (auto)", density, 1.0 / kFarthestDensity, kFarthestDensity)) {
    look.densityScale = density;
    changed = true;
  }
  glm::dvec3 albedo = look.albedo.value_or(glm::dvec3(0.9));
  if (editColor("Albedo", albedo)) {
    look.albedo = albedo;
    changed = true;
  }
  return changed;
}

}  // namespace

/// Takes the volumes of the scene where something else has changed them: a scene that was opened, an edit that was undone.
void AddedPanel::follow(const ViewState& state) {
  if (shownOf(entries_) == state.scene.added) return;
  entries_.clear();
  for (const AddedVolume& volume : state.scene.added) entries_.push_back({volume});
}

void AddedPanel::drawEntry(ViewState& state, std::size_t index, bool& isRemoved) {
  WithEye<AddedVolume>& entry = entries_[index];
  ImGui::PushID(int(index));
  bool changed = checkBox("##shown", &entry.isShown);
  hint("Whether the volume is drawn");
  ImGui::SameLine();
  const std::string name = std::filesystem::path(entry.item.input.volume).filename().string();
  if (ImGui::TreeNode("volume", "%s", name.c_str())) {
    changed |= drawOffset(entry.item, state.latest ? state.latest->scene.volume->voxelSize() : 0.01);
    changed |= drawLook(entry.item);
    if (ImGui::Button("Remove", {-1.0f, 0.0f})) isRemoved = true;
    ImGui::TreePop();
  }
  state.changed |= changed;
  ImGui::PopID();
}

void AddedPanel::drawAdding(ViewState& state) {
  const bool isTyped = editText("Add volume", typed_, "a file, or procedural:NAME");
  hint("Draws another volume in the same image, which mixes with the others", "--add");
  if (!isTyped || typed_.empty()) return;
  attempt(state, [&] {
    entries_.push_back({readAddedVolume(meantFile(typed_))});
    typed_.clear();
    state.changed = true;
  });
}

void AddedPanel::draw(ViewState& state) {
  follow(state);
  if (!entries_.empty()) heading("Further volumes");
  const bool changedBefore = state.changed;
  state.changed = false;
  std::optional<std::size_t> removed;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    bool isRemoved = false;
    drawEntry(state, i, isRemoved);
    if (isRemoved) removed = i;
  }
  if (removed) {
    entries_.erase(entries_.begin() + std::ptrdiff_t(*removed));
    state.changed = true;
  }
  drawAdding(state);
  if (state.changed) state.scene.added = shownOf(entries_);
  state.changed |= changedBefore;
}

}  // namespace freevoxels
