#include "apps/view/export_panel.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "apps/common/frame_names.h"
#include "apps/view/export_files.h"
#include "apps/view/flight_panel.h"
#include "apps/view/theme.h"
#include "apps/view/widgets.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr int kMaxCommandLines = 7;  // that are seen at once

std::string savedSentence(const std::string& file) {
  std::error_code unknown;
  const std::filesystem::path whole = std::filesystem::absolute(file, unknown);
  return "saved " + (unknown ? file : whole.lexically_normal().string());
}

void drawCommand(const DrawnImage& drawn, const std::string& file) {
  ImGui::PushFont(monospacedFont());
  const ImGuiStyle& style = ImGui::GetStyle();
  const float room = ImGui::GetContentRegionAvail().x - 2.0f * style.FramePadding.x - style.ScrollbarSize;
  const auto columns = std::size_t(std::max(room / ImGui::CalcTextSize("M").x, 1.0f));
  std::string wrapped = wrappedCommand(commandOf(drawn, file), columns);
  const auto lines = int(1 + std::ranges::count(wrapped, '\n'));
  const float height = float(std::min(lines, kMaxCommandLines)) * ImGui::GetTextLineHeight();
  ImGui::InputTextMultiline("##command", &wrapped, {-1.0f, height + 2.0f * style.FramePadding.y}, ImGuiInputTextFlags_ReadOnly);
  ImGui::PopFont();
}

}  // namespace

ExportPanel::ExportPanel(const Device& device, FileDialog& dialog, int turnFrames, std::function<void()> finished)
    : device_(device), dialog_(dialog), turnFrames_(turnFrames), job_(std::move(finished)) {}

void ExportPanel::askImage() {
  dialog_.save("Save image", imageName_, {".png", ".exr", ".jpg", ".jpeg"}, [this](const std::string& file) {
    imageName_ = file;
    want({[this, file, size = imageSize_](const DrawnImage& drawn, const Progress& progress) {
            if (size && *size != drawn.request.scene.camera.size)
              saveImageOfSize(device_, drawn, *size, file, progress);
            else
              saveImage(device_, drawn, file);
          },
          savedSentence(file)});
  });
}

void ExportPanel::askScene() {
  dialog_.save("Save scene", sceneName_, {".json"}, [this](const std::string& file) {
    sceneName_ = file;
    want({[file](const DrawnImage& drawn, const Progress&) { saveScene(drawn, file); }, savedSentence(file)});
  });
}

void ExportPanel::askMoved(const std::optional<std::string>& flight) {
  dialog_.save(
      flight ? "Save flight: # stands for the digits of a frame's number" : "Save turntable: # stands for the digits of a frame's number",
      turnName_, {".png", ".exr", ".jpg"}, [this, flight](const std::string& pattern) {
        turnName_ = pattern;
        want({[this, moved = MovedFrames{pattern, turnFrames_, flight}](const DrawnImage& of, const Progress& progress) {
                saveMoved(device_, of, moved, progress);
              },
              fmt::format("saved {} frames: {}", turnFrames_, pattern)});
      });
}

void ExportPanel::drawMoved(ViewState& state, const std::optional<std::string>& flight) {
  ImGui::PushID(flight ? "flight" : "turn");
  const float half = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  if (ImGui::Button(flight ? "Save flight..." : "Save turntable...", {half, 0.0f})) askMoved(flight);
  hint(flight ? "Writes the frames of the flight through the keys of the panel View"
              : "Writes an image for each frame of a full turn (Ctrl+T)",
       flight ? "--flight" : nullptr);
  ImGui::SameLine();
  if (ImGui::Button("Copy command", {half, 0.0f}) && state.whole) {
    ImGui::SetClipboardText(commandOf(*state.whole, MovedFrames{turnName_, turnFrames_, flight}).c_str());
    state.notice = flight ? "copied the flight's command" : "copied the turntable command";
  }
  hint("Copies the command line that renders these frames");
  ImGui::PopID();
}

void ExportPanel::askSequence(const Sequence& sequence) {
  dialog_.save("Save sequence: # stands for the digits of a frame's number", sequenceName_, {".png", ".exr", ".jpg"},
               [this, sequence](const std::string& pattern) {
                 sequenceName_ = pattern;
                 want({[this, pattern, sequence](const DrawnImage& of, const Progress& progress) {
                         saveSequence(device_, of, sequence, pattern, progress);
                       },
                       fmt::format("saved {} frames: {}", sequence.files.size(), pattern)});
               });
}

void ExportPanel::copyImage() {
  if (!canCopyImages()) return want({[](const DrawnImage&, const Progress&) {}, ""});
  want({[this](const DrawnImage& drawn, const Progress&) { freevoxels::copyImage(device_, drawn); }, "copied the image"});
}

void ExportPanel::copyCommand(ViewState& state) {
  if (!state.whole) return;
  ImGui::SetClipboardText(commandOf(*state.whole, "image.png").c_str());
  state.notice = "copied the render command";
}

void ExportPanel::draw(ViewState& state) {
  if (!ImGui::CollapsingHeader("Export", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ImGui::PushID("export");
  const float half = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  if (ImGui::Button("Save image...", {half, 0.0f})) askImage();
  hint("Writes .png, .jpg or .exr (Ctrl+S)");
  ImGui::SameLine();
  if (ImGui::Button("Save scene...", {half, 0.0f})) askScene();
  hint("Writes all options as JSON (Ctrl+E)", "--save-scene");
  if (ImGui::Button("Copy image", {half, 0.0f})) copyImage();
  hint("To the clipboard (Ctrl+C)");
  ImGui::SameLine();
  if (ImGui::Button("Copy command", {half, 0.0f})) copyCommand(state);
  hint("Copies the command line that renders this image (Ctrl+Shift+C)");
  if (tick("Colour and scale bar", state.scene.method.annotate)) state.changed = true;
  hint("Over the images that are saved and copied: the colours of the transfer function with their values, and a length where it is exact",
       "--annotate");
  if (state.sequence) {
    if (ImGui::Button("Save sequence...", {-1.0f, 0.0f})) askSequence(*state.sequence);
    hint("Writes an image of each frame, with this camera");
  }
  OutputDescription& output = state.scene.output;
  if (ImGui::TreeNode("Turntable and flight###Turntable")) {
    ImGui::InputInt(beginRow("Frames"), &turnFrames_, 1, 10);
    hint("Of a full turn or a flight", "--frames");
    turnFrames_ = std::clamp(turnFrames_, 1, kMaximumFrames);
    drawMoved(state, std::nullopt);
    if (const std::optional<std::string> flight = flightOf(state)) drawMoved(state, flight);
    ImGui::TreePop();
  }
  if (ImGui::TreeNode("Command line and .exr")) {
    if (tick("32-bit floats", output.fullFloat)) state.retoned = true;
    hint("Of an .exr, instead of 16 bits", "--float");
    if (tick("Depth channel", output.aovs.depth)) state.changed = true;
    hint("In an .exr", "--aov depth");
    if (state.whole) drawCommand(*state.whole, imageName_);
    ImGui::TreePop();
  }
  if (ImGui::TreeNode("Size of saved images")) {
    drawSize(state.scene.camera.size);
    ImGui::TreePop();
  }
  ImGui::PopID();
}

void ExportPanel::drawSize(glm::ivec2 window) {
  static const std::array kSizes{glm::ivec2(1280, 720), glm::ivec2(1920, 1080), glm::ivec2(3840, 2160)};
  std::vector<std::string> words{"that of the window"};
  for (const glm::ivec2 size : kSizes) words.push_back(fmt::format("{} x {}", size.x, size.y));
  words.push_back("other");
  const auto known = std::ranges::find(kSizes, imageSize_.value_or(glm::ivec2(0)));
  int chosen = imageSize_ ? 1 + int(known - kSizes.begin()) : 0;
  if (choose("Size", words, chosen)) {
    imageSize_.reset();
    if (chosen > 0) imageSize_ = chosen <= int(kSizes.size()) ? kSizes[std::size_t(chosen - 1)] : window;
  }
  hint("Pixels of images that are saved; another size than the window's is drawn anew", "--size");
  if (!imageSize_) return;
  ImGui::InputInt2(beginRow("Pixels"), &imageSize_->x);
  *imageSize_ = glm::clamp(*imageSize_, 1, kMaxImageEdge);
}

std::optional<std::pair<std::string, double>> ExportPanel::activity() const {
  if (job_.busy()) return job_.activity();
  if (!waiting_.empty()) return std::pair<std::string, double>("waiting for the complete image", 0.0);
  return std::nullopt;
}

void ExportPanel::want(Task task) {
  waiting_.push_back(std::move(task));
}

void ExportPanel::cancel() {
  waiting_.clear();
  job_.cancel();
}

void ExportPanel::follow(ViewState& state) {
  if (const std::optional<ExportJob::Outcome> outcome = job_.take())
    (outcome->done || outcome->cancelled ? state.notice : state.problem) = outcome->sentence;
  if (waiting_.empty() || job_.busy()) return;
  if (state.failed) {
    state.problem = "not saved, as there is no image: " + state.problem;
    waiting_.clear();
  } else if (state.complete) {
    Task next = std::move(waiting_.front());
    waiting_.pop_front();
    if (next.done.empty()) {
      copyCommand(state);
      state.notice = "copied the render command: images can be copied if xclip or wl-clipboard is installed";
      return;
    }
    job_.start([work = std::move(next.work), drawn = state.whole](const Progress& progress) { work(*drawn, progress); },
               std::move(next.done));
  }
}

}  // namespace freevoxels
