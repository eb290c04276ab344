#pragma once
// The options of `freevoxels-view`: those of `freevoxels render` without its outputs.

#include <optional>
#include <string>

#include "apps/common/device_options.h"
#include "apps/common/program.h"
#include "apps/common/scene_options.h"
#include "apps/common/sequence.h"

namespace freevoxels {

struct ViewOptions {
  SceneOptions scene;
  DeviceOptions device;
  MessageOptions messages;
  std::optional<Sequence> sequence;  ///< the sequence of which IN is a frame
  std::optional<std::string> showOn;  ///< WindowDevices
  std::optional<std::string> screenshot;
  std::optional<int> after;

  void add(CLI::App& app);
  /// Checks the options before a window is opened.
  void prepare();
};

/// Names the volume to open, a procedural one if there is none, and the first frame of a sequence, which is returned. Fails for
/// fields that are wrong for every volume, and where there is no such file.
std::optional<Sequence> takeVolume(SceneDescription& scene);

}  // namespace freevoxels
