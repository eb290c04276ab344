#include "apps/view/volume_panel.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "apps/common/failure.h"
#include "apps/view/actions.h"
#include "apps/view/clip_panel.h"
#include "apps/view/keys.h"
#include "apps/view/opened_file.h"
#include "apps/view/widgets.h"
#include "engine/core/error.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

namespace {

constexpr int kMaxFramesPerSecond = 120;

int frameOf(const ViewState& state) {
  const auto& files = state.sequence->files;
  return int(std::ranges::find(files, state.scene.input.volume) - files.begin());
}

}  // namespace

std::vector<GridChoice> GridList::list(const std::string& input) {
  if (InputDescription{.volume = input}.kind() != VolumeKind::OpenVdb) return {};
  try {
    return listVdb(input);
  } catch (const Error&) {
    return {};
  }
}

bool chooseGrid(const char* label, const std::vector<GridChoice>& grids, bool GridChoice::*suits,
                const char* none, std::optional<std::string>& name) {
  std::vector<std::string> words{none};
  for (const GridChoice& grid : grids)
    if (grid.*suits) words.push_back(grid.name);
  const auto given = name ? std::ranges::find(words.begin() + 1, words.end(), *name) : words.begin();
  if (given == words.end()) words.push_back(*name);
  int chosen = name ? int(std::ranges::find(words.begin() + 1, words.end(), *name) - words.begin()) : 0;
  if (!choose(label, words, chosen)) return false;
  name = chosen > 0 ? std::optional(words[std::size_t(chosen)]) : std::nullopt;
  return true;
}

void VolumePanel::drawGrids(ViewState& state, GridList& grids) {
  const std::vector<GridChoice>* const all = grids.of(state.scene.input.volume);
  if (!all) return;
  const bool someDensities = std::ranges::count(*all, true, &GridChoice::isDensity) > 1;
  const bool someColors = std::ranges::count(*all, true, &GridChoice::isAlbedo) > 0;
  ClassificationDescription& classification = state.scene.classification;
  if (someDensities) {
    if (chooseGrid("Grid", *all, &GridChoice::isDensity, "automatic", state.scene.input.grid)) {
      classification.densityScale.reset();  // that of other values
      state.changed = true;
    }
    hint("The densities, or the values of a transfer function", "--grid");
  }
  if (someColors && !classification.transferFunction) {
    std::vector<GridChoice> choice = *all;
    choice.insert(choice.begin(), {.name = kNone, .isAlbedo = true});
    state.changed |= chooseGrid("Albedo grid", choice, &GridChoice::isAlbedo, "automatic", classification.albedoGrid);
    hint("Albedos voxel by voxel", "--albedo-grid");
  }
}

void VolumePanel::drawFacts(const ViewState& state) {
  const std::string& file = state.scene.input.volume;
  ImGui::TextUnformatted(std::filesystem::path(file).filename().c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", file.c_str());
  if (!state.latest || state.latest->request.scene.input.volume != file) return;
  const Volume& volume = *state.latest->scene.volume;
  const glm::ivec3 size = volume.dimensions;
  const double millions = 1e-6 * double(volume.activeVoxels);
  const std::string active = millions < 0.1 ? fmt::format("{}", volume.activeVoxels) : fmt::format("{:.3g} million", millions);
  ImGui::TextDisabled("%d × %d × %d voxels, %s active", size.x, size.y, size.z, active.c_str());
  ImGui::TextDisabled("values %.4g to %.4g, voxel size %.3g", double(volume.minimum), double(volume.maximum), volume.voxelSize());
  ImGui::PushTextWrapPos(0.0f);
  for (const std::string& remark : volume.remarks) ImGui::TextDisabled("%s", withOptions(remark).c_str());
  ImGui::PopTextWrapPos();
}

void VolumePanel::draw(ViewState& state, GridList& grids) {
  if (!ImGui::CollapsingHeader("Volume", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ImGui::PushID("volume");
  drawFacts(state);
  if (proceduralName(state.scene.input.volume)) {
    int resolution = state.scene.input.resolution ? state.scene.input.resolution->x : kDefaultResolution;
    slideWhole("Resolution", resolution, 16, 512, fmt::format("{} voxels", resolution_.value_or(resolution)), true);
    hint("Voxels along the edge of the box", "--resolution");
    if (ImGui::IsItemActive()) resolution_ = resolution;
    if (ImGui::IsItemDeactivatedAfterEdit() && resolution_) {
      state.scene.input.resolution = glm::ivec3(*resolution_);
      state.changed = true;
    }
  }
  drawGrids(state, grids);
  const std::vector<GridChoice>* const all = grids.of(state.scene.input.volume);
  channels_.draw(state, all ? std::size_t(std::ranges::count(*all, true, &GridChoice::isScalar)) : 0);
  drawClipping(state);
  frames_.draw(state);
  added_.draw(state);
  ImGui::PopID();
}

/// A file may be one of several, found once it is opened.
void SequencePanel::offer(ViewState& state) {
  const std::string& file = state.scene.input.volume;
  if (offeredFor_ != file) {
    offeredFor_ = file;
    offered_ = proceduralName(file) || !mayBeFrame(file) ? std::nullopt : sequenceAround(file);
  }
  if (!offered_) return;
  const std::string text = fmt::format("Open all {} frames", offered_->files.size());
  if (ImGui::Button(text.c_str(), {-1.0f, 0.0f})) state.sequence = offered_;
}

void SequencePanel::drawControls(ViewState& state, int& frame) {
  const int last = int(state.sequence->files.size()) - 1;
  const std::string& file = state.sequence->files[std::size_t(std::clamp(frame, 0, last))];
  int number = frame + 1;
  if (slideWhole("Frame", number, 1, last + 1, fmt::format("{} of {}", number, last + 1))) {
    frame = number - 1;
    plays_ = false;
  }
  hint(file.c_str());
  if (ImGui::Button(plays_ ? "Pause (space)###play" : "Play (space)###play", {-1.0f, 0.0f})) playOrPause();
  slideWhole("Rate", framesPerSecond_, 1, kMaxFramesPerSecond, fmt::format("{} a second", framesPerSecond_), true);
  int end = int(end_);
  if (choose("At the end", {"repeat", "turn round", "stop"}, end)) end_ = End(end);
  tick("Whole images", waitsForWhole_);
  hint("Plays each frame when its image is complete, in place of quick images");
  drawSentence(problem_, false);
}

void SequencePanel::playOrPause() {
  plays_ = !plays_;
  problem_.clear();
}

void SequencePanel::takeKeys(int frames, int& frame) {
  if (!keysAreFree()) return;
  if (isKeyPressed(GLFW_KEY_SPACE)) playOrPause();
  const int step = int(isKeyPressed(GLFW_KEY_PERIOD, true)) - int(isKeyPressed(GLFW_KEY_COMMA, true));
  if (step == 0) return;
  plays_ = false;
  frame = (frame + step + frames) % frames;
}

void SequencePanel::play(const ViewState& state, int& frame) {
  const Clock::time_point now = Clock::now();
  const std::chrono::duration<float> time(1.0f / float(framesPerSecond_));
  const bool isReady = waitsForWhole_ ? state.complete || state.failed : state.answered;
  if (!plays_ || state.changed || !isReady || now - shown_ < time) return;
  if (!state.problem.empty()) problem_ = state.problem;
  shown_ = now;
  const int last = int(state.sequence->files.size()) - 1;
  if (end_ != End::Turn) step_ = 1;
  if (frame + step_ >= 0 && frame + step_ <= last) {
    frame += step_;
  } else if (end_ == End::Turn) {
    step_ = -step_;
    frame = std::clamp(frame + step_, 0, last);
  } else if (end_ == End::Repeat) {
    frame = 0;
  } else {
    plays_ = false;
  }
}

void SequencePanel::draw(ViewState& state) {
  if (!state.sequence) return offer(state);
  const int before = frameOf(state);
  int frame = before;
  drawControls(state, frame);
  if (frame != before) state.showFrame(state.sequence->files[std::size_t(frame)]);
}

void SequencePanel::follow(ViewState& state) {
  if (!state.sequence) {
    plays_ = false;
    return;
  }
  const int before = frameOf(state);
  int frame = before;
  takeKeys(int(state.sequence->files.size()), frame);
  play(state, frame);
  if (frame != before) state.showFrame(state.sequence->files[std::size_t(frame)]);
}

}  // namespace freevoxels
