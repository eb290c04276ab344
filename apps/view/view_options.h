#pragma once
// The options of `freevoxels-view`: those of `freevoxels render` without its outputs.

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
  std::optional<Sequence> sequence;  ///< the sequence of which IN is a frame
  std::optional<std::string> screenshot;
  std::optional<int> after;
  std::optional<int> frames;  ///< of a turntable that is saved

  void add(CLI::App& app);
  /// Checks the options before a window is opened.
  void prepare();
  /// Applies a scene, if there is one, and the first frame of a sequence. Without a volume a procedural one
  /// is used. Fails for options that are wrong for every volume.
  void takeScene();
};

}  // namespace freevoxels
