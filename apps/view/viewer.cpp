#include "apps/view/viewer.h"

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/freevoxels/frame_names.h"
#include "apps/view/panels.h"
#include "engine/core/error.h"
#include "engine/image/image.h"
#include "engine/octree/volume_limits.h"

namespace freevoxels {

namespace {

constexpr std::array kDeviceExtensions{VK_KHR_SWAPCHAIN_EXTENSION_NAME};
constexpr glm::ivec2 kWindowSize{1280, 800};
constexpr float kFontPixels = 13.0f;
constexpr float kSidebar = 340.0f;

constexpr double kQuickMilliseconds = 45.0;       // that a whole picture may take while something moves
constexpr std::chrono::milliseconds kNotQuick{150};  // after which one that was quick before is no longer
constexpr std::chrono::milliseconds kStill{120};  // before the whole picture is begun
constexpr std::chrono::milliseconds kPaint{60};  // between frames while a picture is made that is wanted soon
constexpr double kIdleSeconds = 0.25;            // between frames in which nothing happens
constexpr double kSoonSeconds = 0.01;            // in which something does

std::string titleOf(const ViewState& state) {
  return state.scene.input.input + " - FreeVoxels";
}

}  // namespace

Viewer::Viewer(const WindowSystem& windows, const Instance& instance, const ViewOptions& options)
    : options_(options),
      window_(windows, "FreeVoxels", kWindowSize),
      device_(options.device.open(instance, kDeviceExtensions)),
      swapchain_(instance, *device_, window_),
      display_(*device_),
      state_{.scene = options.scene, .method = options.method, .sequence = options.sequence},
      files_(!options.screenshot),
      takeAway_(*device_, options.frames.value_or(kDefaultFrames), Window::wake),
      volumes_(maximumVoxels(*device_)),
      quick_(*device_, volumes_, Window::wake),
      whole_(*device_, volumes_, Window::wake) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  ImFontConfig font;
  font.SizePixels = std::round(kFontPixels * window_.contentScale());
  io.Fonts->AddFontDefault(&font);
  ImGui::StyleColorsDark();
  ImGui::GetStyle().ScaleAllSizes(window_.contentScale());
  files_.remember(state_.sequence ? state_.sequence->pattern : state_.scene.input.input);
  painter_ = std::make_unique<UiPainter>(*device_, swapchain_.format());
}

void Viewer::show(const std::shared_ptr<const Picture>& picture) {
  state_.latest = picture;
  newPicture_ = true;
  rate_.add(Clock::now());
  state_.picturesPerSecond = rate_.perSecond();
  spdlog::debug("{} picture, {}x{}: {:.1f} ms, {:.1f} a second", picture == state_.whole ? "whole" : "quick",
                picture->shown->size().x, picture->shown->size().y, picture->milliseconds,
                state_.picturesPerSecond);
  const bool isAsked = picture->request.number == lastRequest_ && !state_.changed;
  if (!state_.camera && isAsked) state_.begin(picture->scene);
  makeTexture(texture_, picture->shown->size());
  if (picture->compared)
    makeTexture(comparedTexture_, picture->compared->size());
  else
    comparedTexture_ = nullptr;
}

void Viewer::makeTexture(std::unique_ptr<Texture>& texture, glm::ivec2 size) const {
  if (!texture || texture->size() != size) texture = std::make_unique<Texture>(*device_, size, "picture");
}

/// Before the panels, which show the textures.
void Viewer::recordPicture(Commands& commands) const {
  if (!newPicture_) return;
  const DisplayLook look = state_.scene.output.look();
  display_.record(commands, *state_.latest->shown, look, *texture_);
  if (comparedTexture_) display_.record(commands, *state_.latest->compared, look, *comparedTexture_);
}

PictureRequest Viewer::request() const {
  return {.scene = state_.scene,
          .method = state_.method,
          .diagnosis = state_.diagnosis,
          .compared = state_.comparedMethod(),
          .number = lastRequest_};
}

void Viewer::takeResults() {
  const auto take = [this](RenderThread& thread) {
    const std::optional<RenderThread::Result> result = thread.take();
    if (!result) return false;
    answered_ = std::max(answered_, result->number);
    if (!result->picture) {
      state_.problem = result->problem;
      if (&thread == &whole_) failed_ = result->number;
      if (options_.screenshot) std::rethrow_exception(result->failure);
      return false;
    }
    state_.problem.clear();
    const bool isWhole = &thread == &whole_;
    // A whole picture is not replaced by a quick one of the same.
    const std::uint64_t shown = state_.latest ? state_.latest->request.number : 0;
    if (result->number < shown ||
        (!isWhole && state_.whole && result->number <= state_.whole->request.number))
      return false;
    if (isWhole) state_.whole = result->picture;
    show(result->picture);
    return true;
  };
  if (take(quick_)) pace_.took(state_.latest->milliseconds);
  if (take(whole_)) wholeIsQuick_ = state_.latest->milliseconds < kQuickMilliseconds;
}

/// While things change, pictures are made quickly; of what stays, one is made of everything, and abandoned when something
/// changes again.
void Viewer::ask() {
  if (area_.pixels().x > 0 && area_.pixels().y > 0 && state_.scene.camera.size != area_.pixels()) {
    state_.scene.camera.size = area_.pixels();
    state_.changed = true;
  }
  if (area_.pixels().x == 0) return;
  const Clock::time_point now = Clock::now();
  if (state_.changed) {
    state_.changed = false;
    lastChange_ = now;
    ++lastRequest_;
    PictureRequest quick = request();
    if (whole_.busyFor() > kNotQuick) wholeIsQuick_ = false;
    if (wholeIsQuick_ || options_.screenshot) {
      askedOfWhole_ = lastRequest_;
      whole_.ask(std::move(quick));
      return;
    }
    whole_.abandon();
    quick.voxelsAlongEdge = pace_.voxelsAlongEdge();
    quick.scene.camera.size =
        glm::max(glm::ivec2(glm::round(pace_.scale() * glm::dvec2(quick.scene.camera.size))), glm::ivec2(1));
    quick_.ask(std::move(quick));
  }
  // Not both at once, as they share the processor.
  const bool still =
      now - lastChange_ >= kStill && answered_ == lastRequest_ && !area_.moves() && !frames_.plays();
  if (still && askedOfWhole_ != lastRequest_) {
    askedOfWhole_ = lastRequest_;
    whole_.ask(request());
  }
}

bool Viewer::isComplete() const {
  return state_.whole && state_.whole->request.number == lastRequest_ && !state_.changed &&
         state_.latest == state_.whole;
}

void Viewer::drawPanels() {
  state_.complete = isComplete();
  state_.failed = failed_ == lastRequest_ && !state_.changed;
  state_.answered = answered_ == lastRequest_ && !state_.changed;
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_Q, false)) window_.close();
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                      ImGuiWindowFlags_NoSavedSettings;
  const float sidebar = std::min(kSidebar * window_.contentScale(), 0.5f * io.DisplaySize.x);
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize({sidebar, io.DisplaySize.y});
  ImGui::Begin("panels", nullptr, kFixed);
  const auto activity = whole_.activity() ? whole_.activity() : quick_.activity();
  files_.draw(state_);
  frames_.draw(state_);
  drawPanelsOf(state_, activity, looks_);
  takeAway_.draw(state_);
  if (takeAway_.waits()) frames_.pause();  // for the whole picture of this frame
  ImGui::End();

  ImGui::SetNextWindowPos({sidebar, 0.0f});
  ImGui::SetNextWindowSize({io.DisplaySize.x - sidebar, io.DisplaySize.y});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);  // which would hide a part of the picture
  ImGui::Begin("picture", nullptr,
               kFixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar(2);
  area_.draw(state_, texture_.get(), comparedTexture_.get());
  ImGui::End();
}

/// On a processor that draws it all, a window painted at every move of the mouse leaves no time for pictures.
bool Viewer::paints() const {
  const bool waits = answered_ < lastRequest_ && texture_;
  return !waits || newPicture_ || Clock::now() - painted_ >= kPaint;
}

void Viewer::drawFrame() {
  const bool paint = paints();
  if (paint && !swapchain_.acquire()) return;
  window_.beginFrame();
  drawPanels();
  ImGui::Render();
  if (!paint) return;
  painted_ = Clock::now();
  painter_->draw(*ImGui::GetDrawData(), swapchain_, [this](Commands& commands) { recordPicture(commands); });
  newPicture_ = false;
  if (isComplete() && !looks_.waits()) ++completeFrames_;
  if (options_.screenshot && completeFrames_ == options_.after.value_or(1)) writeScreenshot();
  swapchain_.present();
}

void Viewer::writeScreenshot() const {
  const DeferredInterrupts wholeFile;
  writePngTexels(*options_.screenshot, swapchain_.size(), swapchain_.read());
}

/// Until something is to be done, if nothing happens.
double Viewer::patience() const {
  if (options_.screenshot || window_.inputWaits()) return 0.0;
  const bool settles = answered_ < lastRequest_ || (!isComplete() && askedOfWhole_ != lastRequest_);
  return area_.moves() || frames_.plays() || settles ? kSoonSeconds : kIdleSeconds;
}

void Viewer::run() {
  std::string title;
  while (!window_.wantsToClose()) {
    Window::waitForEvents(patience());
    for (const std::string& file : window_.takeDropped()) files_.open(state_, file);
    if (title != titleOf(state_)) window_.setTitle(title = titleOf(state_));
    takeResults();
    drawFrame();
    ask();
    if (options_.screenshot && completeFrames_ >= options_.after.value_or(1)) return;
  }
  window_.hide();
}

}  // namespace freevoxels
