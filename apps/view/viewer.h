#pragma once
// The window with its panels, and the threads that make the images in it.

#include <chrono>
#include <memory>

#include "apps/view/adaptive_resolution.h"
#include "apps/view/appearance_panels.h"
#include "apps/view/export_panel.h"
#include "apps/view/files_panel.h"
#include "apps/view/picture_area.h"
#include "apps/view/picture_rate.h"
#include "apps/view/render_thread.h"
#include "apps/view/sequence_panel.h"
#include "apps/view/swapchain.h"
#include "apps/view/ui_painter.h"
#include "apps/view/view_options.h"
#include "apps/view/view_state.h"
#include "apps/view/volume_cache.h"
#include "apps/view/window.h"
#include "engine/image/display_pass.h"

namespace freevoxels {

class Viewer {
 public:
  /// Fails with ErrorKind::Device if there is no display, or no device that can draw into one.
  Viewer(const WindowSystem& windows, const Instance& instance, const ViewOptions& options);

  /// Runs until the window is closed, or its screenshot is written. Fails as the image of a screenshot does.
  void run();

 private:
  using Clock = std::chrono::steady_clock;

  void takeResults();
  void show(const std::shared_ptr<const Picture>& picture);
  void makeTexture(std::unique_ptr<Texture>& texture, glm::ivec2 size) const;
  void recordPicture(Commands& commands) const;
  PictureRequest request() const;
  void ask();
  bool paints() const;
  void drawFrame();
  void drawPanels();
  bool isComplete() const;
  double patience() const;
  void writeScreenshot() const;

  const ViewOptions options_;
  Window window_;
  const std::unique_ptr<Device> device_;  ///< that makes the pictures and draws the window
  Swapchain swapchain_;
  std::unique_ptr<UiPainter> painter_;
  DisplayPass display_;

  ViewState state_;
  LookPanels looks_;
  PictureArea area_;
  FilesPanel files_;
  SequencePanel frames_;
  ExportPanel takeAway_;
  std::unique_ptr<Texture> texture_, comparedTexture_;

  VolumeCache volumes_;
  RenderThread quick_, whole_;  ///< for images of few voxels, and of all voxels
  std::uint64_t lastRequest_ = 0, askedOfWhole_ = 0, answered_ = 0, failed_ = 0;
  Clock::time_point lastChange_, painted_;
  bool newPicture_ = false;  ///< in state_.latest, and not in the textures yet
  PictureRate rate_;         ///< rate of all images that are shown
  AdaptiveResolution pace_;
  bool wholeIsQuick_ = false;
  int completeFrames_ = 0;
};

}  // namespace freevoxels
