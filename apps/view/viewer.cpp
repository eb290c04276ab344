#include "apps/view/viewer.h"

#include <fmt/format.h>
#include <imgui.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <utility>
#include <vector>

#include "apps/common/failure.h"
#include "apps/common/frame_names.h"
#include "apps/view/export_files.h"
#include "apps/view/inspect_panel.h"
#include "apps/view/navigation.h"
#include "apps/view/opened_file.h"
#include "apps/view/theme.h"
#include "apps/view/view_panel.h"
#include "apps/view/window_parts.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/image/image.h"

namespace freevoxels {

namespace {

constexpr glm::ivec2 kWindowSize{1280, 800};
constexpr float kPanelWidth = 340.0f, kMinPanelWidth = 240.0f;
constexpr float kMinSlicesShare = 0.1f, kMaxSlicesShare = 0.8f;  // of the image's width

constexpr std::chrono::milliseconds kPaint{60};      // between frames while an image is made that is wanted soon
constexpr std::chrono::milliseconds kOneEdit{400};   // after which a change is another step to undo
constexpr std::chrono::milliseconds kLongestEnd{150};  // for threads to abandon what they do
constexpr double kIdleSeconds = 0.25;                // between frames in which nothing happens
constexpr double kSoonSeconds = 0.01;                // in which something does

std::string titleOf(const ViewState& state) {
  return printable(state.scene.input.volume) + " - FreeVoxels";
}

}  // namespace

Viewer::Viewer(const WindowSystem& windows, const Instance& instance, const ViewOptions& options)
    : options_(options),
      window_(windows, "FreeVoxels", kWindowSize),
      devices_(instance, options.device, options.showOn),
      swapchain_(instance, devices_.showing(), window_),
      shown_(devices_),
      state_{{.scene = options.scene.description, .sequence = options.sequence}},
      store_(options.screenshot ? std::filesystem::path() : sessionFolder()),
      dialog_(devices_.showing(), store_),
      look_(devices_.showing()),
      flight_(dialog_),
      export_(devices_.drawing(), dialog_, options.scene.description.camera.frames.value_or(kDefaultFrames), Window::wake),
      slices_(devices_.showing()),
      director_(devices_.drawing(), options.screenshot.has_value()),
      panelWidth_(kPanelWidth * window_.contentScale()) {
  ImGui::GetIO().IniFilename = nullptr;
  state_.takeFlight();
  applyTheme(window_.contentScale());
  painter_ = std::make_unique<UiPainter>(devices_.showing(), swapchain_.format());
  opened(openedName(state_));
}

void Viewer::open(const std::string& file) {
  try {
    if (file != store_.lastScene()) storeLastScene();
    openFile(state_, file);
    if (file != store_.lastScene() && isWorthRemembering(file)) opened(file);
  } catch (...) {
    state_.problem = currentFailure().sentence;
  }
}

/// A volume or a scene that makes an image on its own: it is remembered when there is one.
void Viewer::opened(const std::string& file) {
  opened_ = file;
  openedVolume_ = state_.scene.input.volume;
  thumbnailOf_ = proceduralName(file) ? file : std::filesystem::absolute(file).lexically_normal().string();
  state_.bookmarks = store_.bookmarks(state_.scene.input.volume);
}

void Viewer::takeImages() {
  std::exception_ptr failure;
  const bool isNew = director_.take(state_, failure);
  state_.chooseToneMap();
  takeOutput();
  if (isNew) shown_.show(state_.latest, state_.latest == state_.whole && state_.scene.output.look().background);
  if (options_.screenshot && failure) std::rethrow_exception(failure);
}

std::array<ActionState, kActions> Viewer::actionStates() const {
  std::array<ActionState, kActions> states;
  const auto of = [&](Action action) -> ActionState& { return states[std::size_t(action)]; };
  std::error_code unknown;
  of(Action::RestoreScene).enabled = !store_.lastScene().empty() && std::filesystem::exists(store_.lastScene(), unknown);
  of(Action::Undo).enabled = history_.canUndo();
  of(Action::Redo).enabled = history_.canRedo();
  of(Action::PreviousView).enabled = state_.camera && cameras_.canGoBack();
  of(Action::NextView).enabled = state_.camera && cameras_.canGoForward();
  for (const Action action : {Action::CopyImage, Action::CopyCommand}) of(action).enabled = state_.whole != nullptr;
  of(Action::Axes).ticked = state_.overlays.axes;
  of(Action::Box).ticked = state_.overlays.box;
  of(Action::ScaleBar).ticked = state_.overlays.scaleBar;
  of(Action::ColorBar).ticked = state_.overlays.colorBar;
  of(Action::Slices).ticked = state_.overlays.slices;
  of(Action::Panel).ticked = showsPanel_;
  return states;
}

void Viewer::changeView(Action action) {
  if (!state_.camera) return;
  if (action == Action::FrameVolume && state_.latest) state_.setCamera(framedVolume(state_));
  if (action == Action::Projection) state_.setCamera(withOtherProjection(*state_.camera));
  const int axis = int(action) - int(Action::FromRight);
  if (axis >= 0 && action <= Action::FromBack) state_.setCamera(alongAxis(*state_.camera, state_.pole, axis));
}

void Viewer::perform(Action action) {
  const auto flip = [](bool& shown) { shown = !shown; };
  switch (action) {
    case Action::Open: return dialog_.open([this](const std::string& file) { open(file); });
    case Action::RestoreScene: return open(store_.lastScene().string());
    case Action::SaveImage: return export_.askImage();
    case Action::SaveScene: return export_.askScene();
    case Action::SaveTurntable: return export_.askTurntable();
    case Action::Quit: return window_.close();
    case Action::Undo: return history_.undo(state_);
    case Action::Redo: return history_.redo(state_);
    case Action::PreviousView:
      return cameras_.goBack(state_);
    case Action::NextView:
      return cameras_.goForward(state_);
    case Action::CopyImage: return export_.copyImage();
    case Action::CopyCommand: return ExportPanel::copyCommand(state_);
    case Action::AddBookmark: return addBookmark(state_, store_);
    case Action::Axes: return flip(state_.overlays.axes);
    case Action::Box: return flip(state_.overlays.box);
    case Action::ScaleBar: return flip(state_.overlays.scaleBar);
    case Action::ColorBar: return flip(state_.overlays.colorBar);
    case Action::Slices: return flip(state_.overlays.slices);
    case Action::Panel: return flip(showsPanel_);
    case Action::Keys: return flip(showsKeys_);
    case Action::Cancel:
      return director_.reads() ? director_.giveUpReading() : export_.cancel();
    default:
      return changeView(action);
  }
}

void Viewer::drawSidePanel(float top, float width, float height) {
  beginPart("panels", {0.0f, top}, {width - kSplitterWidth * window_.contentScale(), height}, ImGui::GetStyle().WindowPadding);
  volume_.draw(state_, grids_);
  // Of the older image, whose rows stay where they are.
  ImGui::BeginDisabled(isOpening() && state_.latest);
  look_.draw(state_, grids_);
  light_.draw(state_);
  ImGui::EndDisabled();
  drawViewPanel(state_, store_, flight_);
  export_.draw(state_);
  drawInspectPanel(state_);
  ImGui::End();
}

/// Whether the opened file has made no image yet, so that there is none or an older one.
bool Viewer::isOpening() const {
  if (opened_.empty() || state_.scene.input.volume != openedVolume_) return false;
  return !state_.latest || state_.latest->request.scene.input.volume != openedVolume_;
}

/// Says over the older image why there is no newer one, with what else can be opened.
void Viewer::drawOpening() {
  std::string text = state_.problem;
  if (const auto activity = director_.activity(); activity && text.empty())
    text = director_.reads() ? fmt::format("{}  {:.0f} %\nEscape gives it up", activity->first, 100.0 * activity->second) : activity->first;
  const ImVec2 below = drawOverImage(text, state_.latest != nullptr);
  if (state_.problem.empty() || options_.screenshot) return;
  const OtherFile other = drawOtherFiles(below, store_.recent(), openedName(state_));
  if (other.opensDialog) chosen_ = Action::Open;
  wanted_ = other.file;
}

void Viewer::drawImage(float left, float width, float top, float height) {
  beginPart("image", {left, top}, {width, height}, {0.0f, 0.0f},
            ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  area_.draw(state_, shown_.textures());
  if (state_.overlays.slices) slices_.drawOutlines(state_, {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()});
  if (isOpening()) drawOpening();
  if (!options_.screenshot && !store_.knowsHowToTurn() && state_.camera) drawTurnHint();
  ImGui::End();
}

void Viewer::drawSlices(float left, float top, float height) {
  beginPart("slices", {left, top}, {ImGui::GetIO().DisplaySize.x - left, height}, {4.0f, 4.0f},
            ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  slices_.draw(state_);
  ImGui::End();
}

void Viewer::drawWindow() {
  state_.complete = director_.isComplete(state_) && !state_.retoned;
  state_.failed = director_.hasFailed(state_);
  state_.answered = director_.isAnswered(state_);
  float top = 0.0f;
  chosen_.reset();
  if (ImGui::BeginMainMenuBar()) {
    chosen_ = drawMenus(actionStates());
    top = ImGui::GetWindowSize().y;
    ImGui::EndMainMenuBar();
  }
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float status = ImGui::GetFrameHeight(), height = std::max(display.y - top - status, 1.0f);
  // A window that is narrow for a while leaves the width as it was chosen.
  const float panel = std::min(panelWidth_, std::max(kMaxPanelShare * display.x, 1.0f));
  const float left = showsPanel_ ? panel : 0.0f;
  if (showsPanel_) {
    drawSidePanel(top, panel, height);
    const float least = kMinPanelWidth * window_.contentScale();
    if (const std::optional<float> dragged = drawSplitter("border of the panel", panel, window_.contentScale(), top, height))
      panelWidth_ = std::clamp(*dragged, least, std::max(kMaxPanelShare * display.x, least));
  }
  const float room = std::max(display.x - left, 1.0f), slices = state_.overlays.slices ? std::floor(slicesShare_ * room) : 0.0f;
  drawImage(left, room - slices, top, height);
  if (slices > 1.0f) {
    drawSlices(left + room - slices, top, height);
    if (const std::optional<float> dragged =
            drawSplitter("border of the slices", left + room - slices, window_.contentScale(), top, height))
      slicesShare_ = std::clamp((left + room - *dragged) / room, kMinSlicesShare, kMaxSlicesShare);
  }
  const auto writing = export_.activity();
  const bool cancels = writing.has_value() || director_.reads();
  drawStatusBar(state_, writing ? writing : director_.activity(), cancels, display.y - status, status);
  dialog_.draw();
  drawKeysWindow(showsKeys_);
}

/// What the user has asked for in this frame.
void Viewer::act() {
  volume_.frames().follow(state_);
  if (area_.moves()) flight_.pause();
  flight_.follow(state_, double(ImGui::GetIO().DeltaTime));
  bool restored = false;
  if (const std::optional<std::string> file = std::exchange(wanted_, std::nullopt)) open(*file);
  const auto pressed = pressedAction(dialog_.isOpen());
  for (const std::optional<Action> action : {pressed, chosen_}) {
    if (!action) continue;
    history_.follow(state_, false, false);  // it is a step of its own
    cameras_.follow(state_, false, false);
    perform(*action);
    restored |= *action == Action::Undo || *action == Action::Redo || *action == Action::PreviousView || *action == Action::NextView;
  }
  if (restored) state_.bookmarks = store_.bookmarks(state_.scene.input.volume);  // maybe another volume
  if (area_.hasTurned()) store_.setKnowsHowToTurn();
  export_.follow(state_);
  if (export_.waits()) {  // for the whole image of this frame
    volume_.frames().pause();
    flight_.pause();
  }
  const bool plays = this->plays();
  const Clock::time_point now = Clock::now();
  edited_ = !plays && !restored && (state_.changed || state_.retoned);
  const bool moved = !plays && !restored && state_.moved && !state_.changed;
  if (edited_ || moved) lastEdit_ = now;
  const ImGuiIO& io = ImGui::GetIO();
  const bool held = io.MouseDown[0] || io.MouseDown[1] || io.MouseDown[2] || (ImGui::IsAnyItemActive() && !dialog_.isOpen());
  const bool busy = held || plays || now - lastEdit_ < kOneEdit;
  history_.follow(state_, edited_, busy);
  cameras_.follow(state_, moved, busy);
  if (state_.retoned) {
    shown_.retone();
    state_.retoned = false;
  }
  takeOutput();
}

/// A finished image is shown and saved with the output options of now, whatever they were when it was asked for.
void Viewer::takeOutput() {
  const auto take = [this](std::shared_ptr<const DrawnImage>& drawn) {
    if (drawn && drawn->request.scene.output != state_.scene.output)
      drawn = std::make_shared<const DrawnImage>(withOutput(*drawn, state_.scene.output));
  };
  const bool both = state_.latest == state_.whole;
  take(state_.whole);
  if (both)
    state_.latest = state_.whole;
  else
    take(state_.latest);
}

/// On a processor that draws it all, a window painted at every move of the mouse leaves no time for images.
bool Viewer::paints() const {
  const bool waits = !state_.answered && shown_.exists();
  return !waits || shown_.isNew() || Clock::now() - painted_ >= kPaint;
}

void Viewer::drawFrame() {
  const bool paint = paints();
  if (paint && !swapchain_.acquire()) return;
  takeKeysOfPopups(dialog_.isOpen());
  window_.beginFrame();
  drawWindow();
  act();
  ImGui::Render();
  // Before the window is painted, so that the next image is drawn meanwhile.
  director_.ask(state_, area_.pixels(), area_.moves() || plays());
  if (!paint) return;
  painted_ = Clock::now();
  painter_->draw(*ImGui::GetDrawData(), swapchain_, [this](Commands& commands) { shown_.record(commands, state_.look()); });
  shown_.painted();
  if (director_.isComplete(state_) && !look_.waits() && !grids_.isMaking()) ++completeFrames_;
  if (options_.screenshot && completeFrames_ == options_.after.value_or(1)) writeScreenshot();
  swapchain_.present();
}

void Viewer::writeScreenshot() const {
  const DeferredInterrupts wholeFile;
  writePngTexels(*options_.screenshot, swapchain_.size(), swapchain_.read());
}

/// Remembers the opened file, and its first complete image as its thumbnail.
void Viewer::rememberOpened() {
  if (!director_.isComplete(state_) || state_.scene.input.volume != openedVolume_) return;
  if (!opened_.empty() && isWorthRemembering(opened_)) store_.remember(opened_);
  opened_.clear();
  if (thumbnailOf_.empty() || shown_.fades() || options_.screenshot) return;
  store_.storeThumbnail(thumbnailOf_, downloadImage(devices_.drawing(), *state_.whole->image), state_.scene.output.look());
  thumbnailOf_.clear();
}

void Viewer::storeLastScene() {
  if (store_.lastScene().empty() || !state_.whole) return;
  try {
    std::filesystem::create_directories(store_.lastScene().parent_path());
    saveScene(*state_.whole, store_.lastScene().string());
  } catch (const std::exception& problem) {
    spdlog::debug("{}", problem.what());
  }
}

/// Until something is to be done, if nothing happens.
double Viewer::patience() const {
  if (options_.screenshot || window_.inputWaits() || shown_.isNew()) return 0.0;
  const bool busy = area_.moves() || shown_.fades() || !director_.isSettled() || plays();
  return busy ? kSoonSeconds : kIdleSeconds;
}

void Viewer::run() {
  std::string title;
  while (!window_.wantsToClose()) {
    Window::waitForEvents(patience());
    for (const std::string& file : window_.takeDropped()) open(file);
    // The title names what is shown.
    if ((title.empty() || !isOpening()) && title != titleOf(state_)) window_.setTitle(title = titleOf(state_));
    takeImages();
    drawFrame();
    rememberOpened();
    if (options_.screenshot && completeFrames_ >= options_.after.value_or(1)) return;
  }
  end();
}

/// What cannot be abandoned, such as the reading of a large file, ends with the process: outputs are complete or not there at all.
void Viewer::end() {
  window_.hide();
  storeLastScene();
  director_.end();
  export_.cancel();
  const Clock::time_point latest = Clock::now() + kLongestEnd;
  const auto isBusy = [this] { return director_.isBusy() || export_.isBusy() || look_.waits() || grids_.isMaking(); };
  while (isBusy() && Clock::now() < latest) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  if (!isBusy()) return;
  spdlog::shutdown();
  std::_Exit(int(ExitCode::Success));
}

}  // namespace freevoxels
