#pragma once
// What `render` and `turntable` are told alike, and do alike: pictures of one volume, whose table is made
// once.

#include <vector>

#include "apps/freevoxels/device_options.h"
#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_options.h"
#include "apps/freevoxels/timings_file.h"

namespace freevoxels {

class ProgressLine;

struct RenderOptions {
  SceneOptions scene;
  MethodOptions method;
  DeviceOptions device;
  MessageOptions messages;
  std::optional<std::string> timings;

  void add(CLI::App& app);
  /// Draws one frame of a full turn for each element of `outputs`, which are the files to write it to, in
  /// place of `scene.output.files`. Refuses whatever can be refused before any work.
  void run(const std::vector<std::vector<std::string>>& outputs) const;

 private:
  void check(const std::vector<std::vector<std::string>>& outputs) const;
  void draw(const Device& device, const std::vector<std::vector<std::string>>& outputs,
            RunReport& report) const;
  Scene open(const Device& device, ProgressLine& line, RunReport& report) const;
  OptionList describe(const Scene& scene) const;
};

}  // namespace freevoxels
