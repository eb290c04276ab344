#pragma once
// The last image as textures of the device that draws the window.

#include <chrono>
#include <memory>

#include "apps/view/image_area.h"
#include "apps/view/image_maker.h"
#include "apps/view/window_devices.h"
#include "engine/image/display_pass.h"

namespace freevoxels {

class ShownImage {
 public:
  /// `devices` must outlive it.
  explicit ShownImage(const WindowDevices& devices) : devices_(devices), display_(devices.showing()) {}

  /// Shows another image from the next record() on; gradually in place of the one before if `fades`.
  void show(std::shared_ptr<const DrawnImage> drawn, bool fades);
  /// Makes the textures again, for another look.
  void retone() { isNew_ = drawn_ != nullptr; }
  /// Before what shows the textures: makes those that are not made yet.
  void record(Commands& commands, const DisplayLook& look);
  /// To be called when the window has been painted.
  void painted();

  bool exists() const { return texture_ != nullptr; }
  bool isNew() const { return isNew_; }  ///< whether record() has something to do
  bool fades() const;
  ShownTextures textures() const;

 private:
  using Clock = std::chrono::steady_clock;

  const WindowDevices& devices_;
  DisplayPass display_;
  std::shared_ptr<const DrawnImage> drawn_;
  RenderTarget moved_, movedCompared_;  ///< of drawn_, where the device that draws the window is not that of the image
  std::unique_ptr<Texture> texture_, before_, compared_;
  Clock::time_point since_;
  bool isNew_ = false;
  bool isOpaque_ = false, beforeIsOpaque_ = false;  ///< whether the textures have a background
};

}  // namespace freevoxels
