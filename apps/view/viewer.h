#pragma once
// The window with its panels, and the threads that make the images in it.

#include <array>
#include <chrono>
#include <memory>

#include "apps/view/actions.h"
#include "apps/view/export_panel.h"
#include "apps/view/file_dialog.h"
#include "apps/view/flight_panel.h"
#include "apps/view/image_area.h"
#include "apps/view/image_director.h"
#include "apps/view/light_panel.h"
#include "apps/view/look_panel.h"
#include "apps/view/session_store.h"
#include "apps/view/shown_image.h"
#include "apps/view/slice_view.h"
#include "apps/view/swapchain.h"
#include "apps/view/ui_painter.h"
#include "apps/view/view_options.h"
#include "apps/view/view_state.h"
#include "apps/view/volume_panel.h"
#include "apps/view/window.h"
#include "apps/view/window_devices.h"

namespace freevoxels {

/// The viewer's window: draws the panels and the image in it, and performs what the user chooses. Used by the main thread alone; other
/// threads make images (image_maker.h) and write files (export_job.h).
class Viewer {
 public:
  /// Fails with ErrorKind::Device if there is no display, or no device that can draw into one.
  Viewer(const WindowSystem& windows, const Instance& instance, const ViewOptions& options);

  /// Runs until the window is closed, or its screenshot is written. Fails as the image of a screenshot does.
  void run();

 private:
  using Clock = std::chrono::steady_clock;

  void takeImages();
  bool paints() const;
  void drawFrame();
  void drawWindow();
  void drawSidePanel(float top, float width, float height);
  void drawImage(float left, float width, float top, float height);
  void drawSlices(float left, float top, float height);
  void act();
  void takeOutput();
  void perform(Action action);
  void changeView(Action action);
  std::array<ActionState, kActions> actionStates() const;
  void open(const std::string& file);
  void opened(const std::string& file);
  void rememberOpened();
  bool isOpening() const;
  void drawOpening();
  void storeLastScene();
  bool plays() const { return volume_.frames().plays() || flight_.plays(); }
  double patience() const;
  void writeScreenshot() const;
  void end();

  const ViewOptions options_;
  Window window_;
  const WindowDevices devices_;
  Swapchain swapchain_;
  std::unique_ptr<UiPainter> painter_;
  ShownImage shown_;

  ViewState state_;
  EditHistory history_;
  CameraHistory cameras_;
  SessionStore store_;
  FileDialog dialog_;
  GridList grids_;
  VolumePanel volume_;
  LookPanel look_;
  LightPanel light_;
  FlightPanel flight_;
  ExportPanel export_;
  ImageArea area_;
  SliceView slices_;
  ImageDirector director_;

  float panelWidth_, slicesShare_ = 0.3f;  ///< of the image's width
  bool showsPanel_ = true, showsKeys_ = false;
  std::optional<Action> chosen_;       ///< in the menus
  std::optional<std::string> wanted_;  ///< a file to open in place of one that cannot be drawn
  std::string openedVolume_;           ///< the volume that the last opened file names
  std::string opened_;                 ///< that file, until its image is complete
  std::string thumbnailOf_;            ///< the opened file that has no thumbnail yet
  bool edited_ = false;                ///< in the last frame
  Clock::time_point lastEdit_, painted_;
  int completeFrames_ = 0;
};

}  // namespace freevoxels
