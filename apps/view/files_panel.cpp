#include "apps/view/files_panel.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "apps/freevoxels/failure.h"
#include "apps/view/file_field.h"
#include "apps/view/opened_file.h"

namespace freevoxels {

FilesPanel::FilesPanel(bool remembers) : recent_(remembers ? recentFilesPath() : std::filesystem::path()) {}

void FilesPanel::open(ViewState& state, const std::string& file) {
  problem_.clear();
  try {
    openFile(state, file);
    remember(file);
  } catch (...) {
    problem_ = currentFailure().sentence;
  }
}

void FilesPanel::remember(const std::string& file) {
  if (isWorthRemembering(file)) recent_.add(file);
}

void FilesPanel::drawRecent(ViewState& state) {
  if (recent_.list().empty() || !ImGui::TreeNode("recent")) return;
  std::string chosen;
  for (const std::string& file : recent_.list()) {
    ImGui::PushID(file.c_str());
    if (ImGui::Selectable(std::filesystem::path(file).filename().c_str())) chosen = file;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", file.c_str());
    ImGui::PopID();
  }
  ImGui::TreePop();
  if (!chosen.empty()) open(state, chosen);
}

void FilesPanel::draw(ViewState& state) {
  const bool asked = ImGui::GetIO().KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_O, false);
  if (asked) ImGui::SetNextItemOpen(true);
  if (!ImGui::CollapsingHeader("Open", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ImGui::PushID("open");
  if (fileField("Open", name_, asked)) open(state, meantFile(name_));
  drawSentence(problem_, false);
  drawRecent(state);
  ImGui::PopID();
}

}  // namespace freevoxels
