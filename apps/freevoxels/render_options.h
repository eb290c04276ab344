#pragma once
// What `render` and `turntable` are told alike, and do alike: images of one volume, whose table is made once, or of several.

#include <span>
#include <string>
#include <vector>

#include "apps/freevoxels/device_options.h"
#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_options.h"
#include "apps/freevoxels/timings_file.h"

namespace freevoxels {

/// A volume, and the images of it to write: one view in several forms.
struct Frame {
  std::string input;
  std::vector<std::string> files;
};

struct RenderOptions {
  SceneOptions scene;
  MethodOptions method;
  DeviceOptions device;
  MessageOptions messages;
  std::optional<std::string> timings;
  bool fixedView = true;  ///< whether all frames are seen as the first one is where options leave that open

  void add(CLI::App& app);
  /// Draws the frames; those of one volume are the steps of a full turn. Refuses whatever can be refused before any work.
  void run(std::span<const Frame> frames) const;
  /// Without lighting.
  FrameSettings frameSettings() const;

 private:
  void check(std::span<const Frame> frames) const;
};

}  // namespace freevoxels
