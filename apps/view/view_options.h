#pragma once
// What `freevoxels-view` is told: what `freevoxels render` is, but for its outputs.

#include <optional>
#include <string>

#include "apps/freevoxels/device_options.h"
#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_options.h"
#include "apps/freevoxels/sequence.h"

namespace freevoxels {

struct ViewOptions {
  SceneOptions scene;
  MethodOptions method;
  DeviceOptions device;
  MessageOptions messages;
  std::optional<Sequence> sequence;  ///< that IN is a frame of
  std::optional<std::string> screenshot;
  std::optional<int> after;
  std::optional<int> frames;  ///< of a turn that is saved

  void add(CLI::App& app);
  /// Refuses what is wrong before a window is opened.
  void prepare();
  /// Takes a scene, where one is named, and the first frame of a sequence. Without a volume there is one that
  /// is made here. Refuses what is wrong with any volume.
  void takeScene();
};

}  // namespace freevoxels
