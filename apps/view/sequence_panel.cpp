#include "apps/view/sequence_panel.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "apps/view/file_field.h"

namespace freevoxels {

namespace {

constexpr float kMostFramesPerSecond = 120.0f;

int frameOf(const ViewState& state) {
  const auto& files = state.sequence->files;
  return int(std::ranges::find(files, state.scene.input.input) - files.begin());
}

}  // namespace

/// A file may be one of several, found once it is opened.
void SequencePanel::offer(ViewState& state) {
  const std::string& file = state.scene.input.input;
  if (offeredFor_ != file) {
    offeredFor_ = file;
    offered_ = proceduralName(file) ? std::nullopt : sequenceAround(file);
  }
  if (!offered_) return;
  const std::string text = fmt::format("All {} frames of this volume", offered_->files.size());
  if (ImGui::Button(text.c_str())) state.sequence = offered_;
}

void SequencePanel::drawControls(ViewState& state, int& frame) {
  const int last = int(state.sequence->files.size()) - 1;
  const std::string& file = state.sequence->files[std::size_t(std::clamp(frame, 0, last))];
  ImGui::SetNextItemWidth(-1.0f);
  if (ImGui::SliderInt("##frame", &frame, 0, last, std::filesystem::path(file).filename().c_str(),
                       ImGuiSliderFlags_AlwaysClamp)) {
    plays_ = false;
  }
  if (ImGui::Button(plays_ ? "Pause (space)" : "Play (space)")) playOrPause();
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1.0f);
  ImGui::SliderFloat("##rate", &framesPerSecond_, 1.0f, kMostFramesPerSecond, "%.0f frames a second",
                     ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
  drawSentence(problem_, false);
}

void SequencePanel::playOrPause() {
  plays_ = !plays_;
  problem_.clear();
}

void SequencePanel::takeKeys(int frames, int& frame) {
  if (ImGui::GetIO().WantTextInput) return;
  if (ImGui::IsKeyPressed(GLFW_KEY_SPACE, false)) playOrPause();
  const int step = int(ImGui::IsKeyPressed(GLFW_KEY_PERIOD)) - int(ImGui::IsKeyPressed(GLFW_KEY_COMMA));
  if (step == 0) return;
  plays_ = false;
  frame = (frame + step + frames) % frames;
}

void SequencePanel::play(const ViewState& state, int& frame) {
  const Clock::time_point now = Clock::now();
  const std::chrono::duration<float> time(1.0f / framesPerSecond_);
  if (!plays_ || state.changed || !state.answered || now - shown_ < time) return;
  if (!state.problem.empty()) problem_ = state.problem;
  shown_ = now;
  frame = (frame + 1) % int(state.sequence->files.size());
}

void SequencePanel::draw(ViewState& state) {
  if (!state.sequence) {
    plays_ = false;
    return offer(state);
  }
  const int before = frameOf(state);
  int frame = before;
  if (ImGui::CollapsingHeader("Frames", ImGuiTreeNodeFlags_DefaultOpen)) drawControls(state, frame);
  takeKeys(int(state.sequence->files.size()), frame);
  play(state, frame);
  if (frame != before) state.showFrame(state.sequence->files[std::size_t(frame)]);
}

}  // namespace freevoxels
