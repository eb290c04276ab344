#pragma once
// The device that makes the images, and the one that draws the window.

#include <memory>
#include <optional>
#include <string>

#include "apps/common/device_options.h"
#include "engine/vulkan/image.h"

namespace freevoxels {

/// The value of --show-on for which a device is chosen.
inline constexpr const char* kShowOnAuto = "auto";

/// They are two where the display cannot present from the first, as on remote desktops of machines with a GPU; images then go from one to
/// the other by the host.
class WindowDevices {
 public:
  /// `showOn` names the device that draws the window as DeviceOptions::selector does. Without it, or if it is kShowOnAuto, that is the
  /// device of `device`, or where this cannot present, a CPU device, which a message says. Fails with ErrorKind::Device as Device does.
  WindowDevices(const Instance& instance, const DeviceOptions& device, const std::optional<std::string>& showOn);

  const Device& drawing() const { return *drawing_; }
  const Device& showing() const { return showing_ ? *showing_ : *drawing_; }
  bool areOne() const { return showing_ == nullptr; }
  /// An RGBA32F image of the drawing device, complete and in layout GENERAL, on the showing one. Waits.
  RenderTarget moved(const RenderTarget& image) const;

 private:
  std::unique_ptr<Device> drawing_, showing_;  ///< showing_: null where it is the same
};

/// Opens a hidden window and all that presents images in it, as the process does that WindowDevices starts for a try: drivers of GPUs may
/// end it. Fails with ErrorKind::Device.
void tryPresentation(const DeviceOptions& device);

/// The program's option, which nobody else gives, for that process.
inline constexpr const char* kTryPresentation = "--try-presentation";

}  // namespace freevoxels
