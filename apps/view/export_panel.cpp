#include "apps/view/export_panel.h"

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <filesystem>

#include "apps/freevoxels/frame_names.h"
#include "apps/view/file_field.h"
#include "apps/view/picture_files.h"
#include "apps/view/wrapped_command.h"

namespace freevoxels {

namespace {

constexpr int kMostCommandLines = 9;  // that are seen at once

std::string savedSentence(const std::string& file) {
  std::error_code unknown;
  const std::filesystem::path whole = std::filesystem::absolute(file, unknown);
  return "saved " + (unknown ? file : whole.lexically_normal().string());
}

}  // namespace

ExportPanel::ExportPanel(const Device& device, int turnFrames, std::function<void()> finished)
    : device_(device), turnFrames_(turnFrames), job_(std::move(finished)) {}

void ExportPanel::takeKeys() {
  if (ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false) && !ImGui::GetIO().WantTextInput) cancel();
  if (!ImGui::GetIO().KeyCtrl) return;
  if (ImGui::IsKeyPressed(GLFW_KEY_S, false)) focus_ = Field::Picture;
  if (ImGui::IsKeyPressed(GLFW_KEY_E, false)) focus_ = Field::Scene;
  if (ImGui::IsKeyPressed(GLFW_KEY_T, false)) focus_ = Field::Turn;
}

void ExportPanel::draw(ViewState& state) {
  takeKeys();
  begin(state);
  if (focus_ != Field::None) ImGui::SetNextItemOpen(true);
  if (!ImGui::CollapsingHeader("Export", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ImGui::PushID("take away");
  if (state.whole) drawCommand(*state.whole, meantFile(pictureName_));
  drawPictureFields(state);
  drawTurn(state.whole.get());
  drawWork();
  ImGui::PopID();
}

void ExportPanel::drawCommand(const Picture& picture, const std::string& file) {
  const float width = ImGui::GetContentRegionAvail().x;
  const ImGuiStyle& style = ImGui::GetStyle();
  const float room = width - 2.0f * style.FramePadding.x - style.ScrollbarSize;
  const auto columns = std::size_t(std::max(room / ImGui::CalcTextSize("M").x, 1.0f));
  const std::string command = commandOf(picture, file);
  std::string wrapped = wrappedCommand(command, columns);
  const auto lines = int(1 + std::ranges::count(wrapped, '\n'));
  const float height = float(std::min(lines, kMostCommandLines)) * ImGui::GetTextLineHeight();
  ImGui::InputTextMultiline("##command", &wrapped, {width, height + 2.0f * style.FramePadding.y},
                            ImGuiInputTextFlags_ReadOnly);
  if (ImGui::Button("Copy command line")) ImGui::SetClipboardText(command.c_str());
}

bool ExportPanel::wants(Field field, const char* button, std::string& name) {
  const bool focused = focus_ == field;
  if (focused) focus_ = Field::None;
  return fileField(button, name, focused);
}

void ExportPanel::drawPictureFields(ViewState& state) {
  if (wants(Field::Picture, "Save picture", pictureName_)) {
    const std::string file = meantFile(pictureName_);
    want({[this, file](const Picture& picture, const Progress&) { savePicture(device_, picture, file); },
          savedSentence(file)});
  }
  OutputOptions& output = state.scene.output;
  state.changed |= ImGui::Checkbox(".exr of 32 bits", &output.fullFloat);
  ImGui::SameLine();
  state.changed |= ImGui::Checkbox("with depth", &output.aovs.depth);
  if (wants(Field::Scene, "Save scene", sceneName_)) {
    const std::string file = meantFile(sceneName_);
    want(
        {[file](const Picture& picture, const Progress&) { saveScene(picture, file); }, savedSentence(file)});
  }
}

void ExportPanel::drawTurn(const Picture* picture) {
  if (wants(Field::Turn, "Save turn", turnName_)) {
    const std::string pattern = meantFile(turnName_);
    want({[this, pattern, frames = turnFrames_](const Picture& of, const Progress& progress) {
            saveTurn(device_, of, pattern, frames, progress);
          },
          fmt::format("saved {} frames: {}", turnFrames_, pattern)});
  }
  ImGui::SetNextItemWidth(0.3f * ImGui::GetContentRegionAvail().x);
  ImGui::InputInt("frames", &turnFrames_, 1, 10);
  turnFrames_ = std::clamp(turnFrames_, 1, kMaximumFrames);
  ImGui::SameLine();
  if (ImGui::Button("Copy command line##turn") && picture != nullptr)
    ImGui::SetClipboardText(turnCommandOf(*picture, meantFile(turnName_), turnFrames_).c_str());
}

void ExportPanel::drawWork() {
  const bool busy = job_.busy();
  if (busy || !waiting_.empty()) {
    const auto [stage, fraction] =
        busy ? job_.activity() : std::pair<std::string, double>("waiting for the whole picture", 0.0);
    ImGui::TextWrapped("%s", stage.c_str());
    if (ImGui::Button("Cancel")) cancel();
    ImGui::SameLine();
    ImGui::ProgressBar(float(fraction), {-1.0f, 0.0f});
  } else {
    drawSentence(last_.sentence, last_.done);
  }
}

void ExportPanel::want(Task task) {
  last_ = {};
  waiting_.push_back(std::move(task));
}

void ExportPanel::cancel() {
  waiting_.clear();
  job_.cancel();
}

void ExportPanel::begin(const ViewState& state) {
  if (std::optional<ExportJob::Outcome> outcome = job_.take()) last_ = std::move(*outcome);
  if (waiting_.empty() || job_.busy()) return;
  if (state.failed) {
    last_ = {false, "not saved, as there is no picture: " + state.problem};
    waiting_.clear();
  } else if (state.complete) {
    Task& next = waiting_.front();
    job_.start([work = std::move(next.work),
                picture = state.whole](const Progress& progress) { work(*picture, progress); },
               std::move(next.done));
    waiting_.pop_front();
  }
}

}  // namespace freevoxels
