#pragma once
// What `freevoxels-view` is told: what `freevoxels render` is, but for its outputs.

#include <optional>
#include <string>

#include "apps/freevoxels/device_options.h"
#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_options.h"

namespace freevoxels {

struct ViewOptions {
  SceneOptions scene;
  MethodOptions method;
  DeviceOptions device;
  MessageOptions messages;
  std::optional<std::string> screenshot;
  std::optional<int> after;

  void add(CLI::App& app);
  /// Takes a scene, and refuses what is wrong before a window is opened. Without a volume there is one that
  /// is made here.
  void prepare();
};

}  // namespace freevoxels
