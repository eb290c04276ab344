#include "apps/view/look_panel.h"

#include <imgui.h>
#include <imgui_stdlib.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "apps/view/theme.h"
#include "apps/view/ui_painter.h"
#include "engine/core/atomic_file.h"
#include "engine/description/scene_fields.h"
#include "engine/description/text_values.h"
#include "engine/image/image.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

constexpr const char* kFirstPreset = "fog";

/// The values under the curves.
ValueWindow shownWindow(const ClassificationDescription& options, const TransferModel& model, const Volume& volume) {
  return options.window.value_or(model.window({volume.minimum, volume.maximum}));
}

constexpr double kMinOffset = -2000.0, kMaxOffset = 4000.0;  // kelvin

}  // namespace

PresetImages::PresetImages(const Device& device)
    : device_(device), images_([this](const std::shared_ptr<const DrawnImage>& like) { return draw(*like); }) {}

PresetImages::~PresetImages() {
  ends_ = true;
}

/// An empty image where it cannot be drawn.
std::vector<Image> PresetImages::draw(const DrawnImage& like) const {
  constexpr int kVoxels = 48;
  struct Abandoned {};
  const Progress progress = [this](std::string_view, double) {
    if (ends_) throw Abandoned();
  };
  ImageRequest request{.scene = like.request.scene, .voxelsAlongEdge = kVoxels};
  request.scene.camera.size = 2 * kSize;
  VolumeCache volumes(request.scene, like.scene.volume);
  std::vector<Image> images(transferPresets().size());
  for (std::size_t i = 0; i < transferPresets().size(); ++i) try {
      if (ends_) break;
      request.scene.classification = {.transferFunction = std::string(transferPresets()[i].json)};
      ImageMaker maker(device_, volumes);
      images[i] = downloadImage(device_, *maker.make(request, progress).image);
    } catch (const Abandoned&) {
      break;
    } catch (const std::exception& problem) {
      spdlog::debug("image of the preset {}: {}", transferPresets()[i].name, problem.what());
    }
  return images;
}

const Texture* PresetImages::of(std::size_t preset, const std::shared_ptr<const DrawnImage>& latest) {
  if (!like_ || like_->scene.volume != latest->scene.volume) {
    like_ = latest;
    textures_.clear();
  }
  const std::vector<Image>* const images = images_.of(like_);
  if (images == nullptr) return nullptr;
  textures_.resize(images->size());
  const Image& image = (*images)[preset];
  if (!textures_[preset] && !image.pixels.empty()) {
    textures_[preset] = std::make_unique<Texture>(device_, image.size, "preset");
    textures_[preset]->upload(device_, srgbTexels(image, {.background = Background{}}));
  }
  return textures_[preset].get();
}

void ClassificationPanel::draw(ViewState& state) {
  ImGui::PushID("classification");
  if (choose("Mode", kModeWords, state.scene.method.mode, IntensityProjection::None)) {
    if (!state.scene.method.isProjected()) state.scene.method.mode.reset();
    state.changed = true;
  }
  hint("The volume as a medium; or the largest values along rays, or their mean", "--mode");
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
    ownUnit_.reset();
    if (text) modelText_.clear();  // which may have both
  }
  if (!text || *text == modelText_) return;
  modelText_ = *text;
  deselect();
  if (const TransferPreset* const preset = presetNamed(*text))
    preset_ = preset->name;
  else if (!isInlineJson(*text))
    file_ = *text;
  attempt(state, [&] { read(*text, volume); });
}

void ClassificationPanel::read(const std::string& text, const Volume& volume) {
  model_ = TransferModel::read(text, volume);
  ownUnit_ = model_.unitDistance;
}

void ClassificationPanel::deselect() {
  curve_ = {};
  strip_ = {};
  preset_.clear();
}

void ClassificationPanel::drawKind(ViewState& state) {
  ClassificationDescription& options = state.scene.classification;
  int kind = options.transferFunction ? 1 : 0;
  if (!choose("Classification", {"density", "transfer function"}, kind)) return;
  if (kind == 0) {
    options = density_;
    if (!options.densityScale)  // else a scan has a transfer function again
      options.densityScale = automaticDensityScale(*state.latest->scene.volume, kAutomaticOpticalDepth);
  } else {
    density_ = options;
    if (modelText_.empty()) {
      read(kFirstPreset, *state.latest->scene.volume);
      modelText_ = preset_ = kFirstPreset;
    }
    options = {.transferFunction = modelText_};
  }
  state.changed = true;
}

void ClassificationPanel::drawDensity(ViewState& state) {
  ClassificationDescription& options = state.scene.classification;
  const Classification& resolved = state.latest->scene.classification;
  const bool automatic = !options.densityScale && !resolved.transferFunction;
  state.changed |=
      scale_.draw("Density scale", "Extinction per world unit where the density is 1", "--density-scale",
                  options.densityScale, automatic ? std::optional(resolved.densityScale) : std::nullopt);
  const glm::vec3 usual = resolved.transferFunction ? Classification{}.albedo : resolved.albedo;
  glm::dvec3 color = options.albedo.value_or(glm::dvec3(usual));
  if (editColor("Albedo", color)) {
    options.albedo = color;
    state.changed = true;
  }
  hint("Share of the light that a voxel scatters", "--albedo");
}

void ClassificationPanel::drawTransferFunction(ViewState& state) {
  const Volume& volume = *state.latest->scene.volume;
  ClassificationDescription& options = state.scene.classification;
  state.changed |= drawPresets(state);
  const ValueWindow window = shownWindow(options, model_, volume);
  bool changed = curve_.draw(model_, {window.low, window.high}, histogram_.of(state.latest->scene.volume));
  changed |= strip_.draw(model_);
  drawWindow(state);
  drawChanges(state);
  std::optional<double> unit = model_.unitDistance == ownUnit_ ? std::nullopt : model_.unitDistance;
  if (unitDistance_.draw("Unit distance", "World length that the opacities are of", "unit_distance of --transfer-function", unit,
                         ownUnit_.value_or(volume.voxelSize()))) {
    model_.unitDistance = unit ? unit : ownUnit_;
    changed = true;
  }
  changed |= drawFile(state);
  if (!changed) return;
  preset_.clear();
  options.transferFunction = modelText_ = model_.json();
  state.changed = true;
}

bool ClassificationPanel::drawPresets(ViewState& state) {
  if (!ImGui::BeginCombo(beginRow("Preset"), preset_.empty() ? "own" : preset_.c_str(), ImGuiComboFlags_HeightLargest)) return false;
  const float scale = ImGui::GetFontSize() / kFontPixels;
  const ImVec2 tile(scale * float(PresetImages::kSize.x), scale * float(PresetImages::kSize.y));
  std::vector<std::string> names;
  for (const TransferPreset& preset : transferPresets()) names.emplace_back(preset.name);
  bool changed = false;
  drawEntries(names, std::size_t(std::ranges::find(names, preset_) - names.begin()), [&](std::size_t i) {
    const std::string& name = names[i];
    ImGui::PushID(int(i));
    const ImVec2 low = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##preset", preset_ == name, 0, {0.0f, tile.y})) {
      deselect();
      read(name, *state.latest->scene.volume);
      state.scene.classification.transferFunction = modelText_ = preset_ = name;
      state.scene.classification.window.reset();
      changed = true;
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 high(low.x + tile.x, low.y + tile.y);
    list.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_FrameBg));
    if (const Texture* const image = presets_.of(i, state.latest)) list.AddImage(textureId(*image), low, high);
    list.AddText({high.x + 8.0f, low.y + 0.5f * (tile.y - ImGui::GetFontSize())}, ImGui::GetColorU32(ImGuiCol_Text), name.c_str());
    ImGui::PopID();
  });
  ImGui::EndCombo();
  return changed;
}

/// As on the console of a CT scanner: the middle and the width of the values that the curve is over.
void ClassificationPanel::drawWindow(ViewState& state) {
  const Volume& volume = *state.latest->scene.volume;
  std::optional<ValueWindow>& given = state.scene.classification.window;
  const ValueWindow all{volume.minimum, volume.maximum}, window = shownWindow(state.scene.classification, model_, volume);
  const double width = all.high - all.low;
  if (!(width > 0.0)) return;
  constexpr double kNarrowest = 1e-3, kWidest = 2.0;
  double middle = 0.5 * (window.low + window.high), shownWidth = window.high - window.low;
  bool changed = slide("Level", middle, all.low, all.high, "%.4g");
  hint("Value in the middle of the curve; right drag in the image changes it, too", "--window");
  changed |= slideLogarithmic("Window", shownWidth, kNarrowest * width, kWidest * width);
  hint("Width of the values under the curve; right drag in the image changes it, too", "--window");
  if (changed) given = movedWindow(window, all, {shownWidth - (window.high - window.low), middle - 0.5 * (window.low + window.high)});
  if (ImGui::Button(given ? "Window of the function" : "Window of all values", {-1.0f, 0.0f})) {
    given = given ? std::nullopt : std::optional(all);
    changed = true;
  }
  state.changed |= changed;
}

/// What changes the function without being part of it.
void ClassificationPanel::drawChanges(ViewState& state) {
  constexpr double kWeakest = 0.01, kStrongest = 100.0;
  ClassificationDescription& options = state.scene.classification;
  double opacity = options.opacity.value_or(1.0);
  if (slideLogarithmic("Opacity", opacity, kWeakest, kStrongest)) {
    options.opacity = opacity;
    state.changed = true;
  }
  hint("Factor of the extinction", "--opacity");
  state.changed |= tick("Invert", options.invert);
  hint("Turns the colours round; opacities stay", "--invert");
}

bool ClassificationPanel::drawFile(ViewState& state) {
  const float buttons = ImGui::CalcTextSize("LoadSave").x + 4.0f * ImGui::GetStyle().FramePadding.x + 2.0f * ImGui::GetStyle().ItemSpacing.x;
  const char* const field = beginRow("File");
  ImGui::SetNextItemWidth(-buttons);
  ImGui::InputTextWithHint(field, "name.json", &file_);
  ImGui::SameLine();
  bool loaded = false;
  if (ImGui::Button("Load") && !file_.empty())
    attempt(state, [&] {
      read(file_, *state.latest->scene.volume);
      deselect();
      loaded = true;
    });
  hint("Reads the curves from this file", "--transfer-function");
  ImGui::SameLine();
  if (ImGui::Button("Save") && !file_.empty())
    attempt(state, [&] {
      std::error_code unknown;
      if (std::filesystem::exists(file_, unknown) && std::exchange(overwritten_, file_) != file_) {
        state.notice = file_ + " is there: press Save again to replace it";
        return;
      }
      TransferModel shown = model_;
      if (const auto& window = state.scene.classification.window) shown.range = glm::dvec2(window->low, window->high);
      writeTextAtomically(file_, shown.json() + "\n");
      overwritten_ = file_;
      state.notice = "saved " + file_;
    });
  hint("Writes the curves into this file", "--transfer-function");
  return loaded;
}

void LookPanel::draw(ViewState& state, GridList& grids) {
  if (opened_ != openedName(state)) {
    opened_ = openedName(state);
    classification_.forgetScales();
    emission_ = {};
  }
  if (state.latest) classification_.follow(state);
  if (!panelHeader("Look", state.latest != nullptr, true)) return;
  const bool isFixed = state.latest->scene.volume->classificationIsFixed;
  if (isFixed) drawSentence("The file was baked for this look alone: bake it with --keep-scalars to change it.", false);
  ImGui::BeginDisabled(isFixed);
  classification_.draw(state);
  emission_.draw(state, grids);
  ImGui::EndDisabled();
}

void EmissionPanel::draw(ViewState& state, GridList& grids) {
  const std::vector<GridChoice>* const all = grids.of(state.scene.input.volume);
  if (!all) return;
  ImGui::PushID("emission");
  EmissionDescription& options = state.scene.emission;
  const bool mayShine = all->empty() || std::ranges::any_of(*all, &GridChoice::isScalar);
  bool shines = options.isAsked() || (options.emission != false && state.latest->scene.classification.emission);
  if (shines || mayShine) {
    if (tick("Emission", shines)) {
      options = {};
      options.emission = shines;
      state.changed = true;
    }
    hint("Hot voxels shine as black bodies", "--emission");
  }
  if (shines) state.changed |= drawOptions(state, *all);
  ImGui::PopID();
}

bool EmissionPanel::drawOptions(ViewState& state, const std::vector<GridChoice>& grids) {
  EmissionDescription& options = state.scene.emission;
  bool changed = false;
  const std::optional<TemperatureGrid>& grid = state.latest->scene.volume->temperature;
  const bool isRadiance = grid && grid->isRadiance;
  if (grids.size() > 1 && !isRadiance) {
    changed |= chooseGrid("Temperature", grids, &GridChoice::isScalar, "automatic", options.temperatureGrid);
    hint("Grid of the temperatures", "--temperature-grid");
  }
  const std::optional<Emission>& resolved = state.latest->scene.classification.emission;
  if (!resolved) return changed;
  const auto automatic = [](const std::optional<double>& given, double value) {
    return given ? std::nullopt : std::optional(value);
  };
  changed |= strength_.draw("Strength", "Luminance per world unit at 2000 K", "--emission", options.strength,
                            automatic(options.strength, resolved->strength));
  if (isRadiance) return changed;
  changed |= scale_.draw("Scale", "Kelvin for each unit of the grid's values", "--temperature-scale", options.temperatureScale,
                         automatic(options.temperatureScale, resolved->temperatureScale), "%.4g K");
  if (options.temperatureScale && !options.temperatureOffset)  // which a scale of its own would make 0
    options.temperatureOffset = resolved->temperatureOffset;
  double offset = options.temperatureOffset.value_or(resolved->temperatureOffset);
  if (slide("Offset", offset, kMinOffset, kMaxOffset, "%.0f K")) {
    options.temperatureOffset = offset;
    changed = true;
  }
  hint("Temperature where the grid's value is 0", "--temperature-offset");
  return changed;
}

}  // namespace freevoxels
