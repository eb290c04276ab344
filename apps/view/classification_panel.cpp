#include "apps/view/classification_panel.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <cmath>

#include "apps/view/transfer_presets.h"
#include "engine/core/atomic_file.h"

namespace freevoxels {

namespace {

glm::dvec2 rangeOf(const TransferModel& model, const Volume& volume) {
  return model.range.value_or(glm::dvec2(volume.minimum, volume.maximum));
}

}  // namespace

void ClassificationPanel::draw(ViewState& state) {
  if (state.latest) follow(state);
  if (!ImGui::CollapsingHeader("Colour and opacity", ImGuiTreeNodeFlags_DefaultOpen) || !state.latest) return;
  ImGui::PushID("classification");
  const LabelRoom room;
  drawKind(state);
  if (state.scene.classification.transferFunction)
    drawTransferFunction(state);
  else
    drawDensity(state);
  ImGui::PopID();
}

/// Another volume, or options that were changed elsewhere.
void ClassificationPanel::follow(ViewState& state) {
  const Volume& volume = *state.latest->scene.volume;
  const std::optional<std::string>& text = state.scene.classification.transferFunction;
  if (volume.source != volume_) {
    volume_ = volume.source;
    histogram_.forget();
    density_ = {};
    model_.range.reset();
    model_.unitDistance.reset();
    if (text) modelText_.clear();  // which may have both
  }
  if (!text || *text == modelText_) return;
  modelText_ = *text;
  deselect();
  if (!isInlineJson(*text)) file_ = *text;
  attempt(state, [&] { model_ = TransferModel::read(*text, volume); });
}

void ClassificationPanel::deselect() {
  curve_ = {};
  strip_ = {};
  preset_.clear();
}

void ClassificationPanel::drawKind(ViewState& state) {
  ClassificationOptions& options = state.scene.classification;
  int kind = options.transferFunction ? 1 : 0;
  if (!choose("look by", {"density", "transfer function"}, kind)) return;
  if (kind == 0) {
    options = density_;
    if (!options.densityScale)  // else a scan has a transfer function again
      options.densityScale = automaticDensityScale(*state.latest->scene.volume, kAutomaticOpticalDepth);
  } else {
    density_ = options;
    if (modelText_.empty()) {
      model_.takeCurves(TransferModel::read(kTransferPresets[0].json, *state.latest->scene.volume));
      preset_ = kTransferPresets[0].name;
    }
    options = {.transferFunction = modelText_ = model_.json()};
  }
  state.changed = true;
}

void ClassificationPanel::drawDensity(ViewState& state) {
  ClassificationOptions& options = state.scene.classification;
  const Classification& resolved = state.latest->scene.classification;
  const bool automatic = !options.densityScale && !resolved.transferFunction;
  state.changed |=
      scale_.draw("density scale", "Extinction per world unit where the density is 1", options.densityScale,
                  automatic ? std::optional(resolved.densityScale) : std::nullopt);
  const glm::vec3 usual = resolved.transferFunction ? Classification{}.albedo : resolved.albedo;
  glm::dvec3 color = options.albedo.value_or(glm::dvec3(usual));
  if (editColor("colour", color)) {
    options.albedo = color;
    state.changed = true;
  }
  hint("Albedo: the share of its light that a voxel scatters");
}

void ClassificationPanel::drawTransferFunction(ViewState& state) {
  const Volume& volume = *state.latest->scene.volume;
  bool changed = drawPresets(volume);
  if (curve_.draw(model_, rangeOf(model_, volume), histogram_.of(state.latest->scene.volume)) |
      strip_.draw(model_)) {
    preset_.clear();
    changed = true;
  }
  changed |= drawRange(volume);
  changed |= unitDistance_.draw("unit length", "World length that the opacities are of", model_.unitDistance,
                                volume.voxelSize());
  changed |= drawFile(state);
  if (!changed) return;
  modelText_ = model_.json();
  state.scene.classification = {.transferFunction = modelText_};
  state.changed = true;
}

bool ClassificationPanel::drawPresets(const Volume& volume) {
  bool changed = false;
  if (!ImGui::BeginCombo("preset", preset_.empty() ? "your own" : preset_.c_str())) return false;
  for (const TransferPreset& preset : kTransferPresets)
    if (ImGui::Selectable(preset.name, preset_ == preset.name)) {
      deselect();
      model_.takeCurves(TransferModel::read(preset.json, volume));
      preset_ = preset.name;
      changed = true;
    }
  ImGui::EndCombo();
  return changed;
}

/// As on the console of a CT scanner: the middle and the width of the values that the curve is over.
bool ClassificationPanel::drawRange(const Volume& volume) {
  const double least = volume.minimum, most = volume.maximum, all = most - least;
  if (!(all > 0.0)) return false;
  constexpr double kNarrowest = 1e-3, kWidest = 2.0;
  const glm::dvec2 range = rangeOf(model_, volume);
  double middle = 0.5 * (range.x + range.y), width = range.y - range.x;
  bool changed = slide("level", middle, least, most, "%.4g");
  hint("The value in the middle of the curve");
  changed |= slideLogarithmic("window", width, kNarrowest * all, kWidest * all);
  hint("How many values the curve is over, from its left to its right end");
  if (changed) {
    const double step = std::pow(10.0, std::floor(std::log10(width)) - 4.0);
    model_.range = glm::dvec2(roundedTo(middle - 0.5 * width, step), roundedTo(middle + 0.5 * width, step));
  }
  if (model_.range && smallButtonAtRight("all")) {
    model_.range.reset();
    changed = true;
  }
  return changed;
}

bool ClassificationPanel::drawFile(ViewState& state) {
  ImGui::SetNextItemWidth(-8.2f * ImGui::GetFontSize());
  ImGui::InputTextWithHint("##file", "FILE.json", &file_);
  ImGui::SameLine();
  bool loaded = false;
  if (ImGui::Button("Load") && !file_.empty())
    attempt(state, [&] {
      model_ = TransferModel::read(file_, *state.latest->scene.volume);
      deselect();
      loaded = true;
    });
  ImGui::SameLine();
  if (ImGui::Button("Save") && !file_.empty())
    attempt(state, [&] { writeTextAtomically(file_, model_.json() + "\n"); });
  hint("For --transfer-function of the programs");
  return loaded;
}

}  // namespace freevoxels
