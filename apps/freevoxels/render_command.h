#pragma once
// freevoxels render IN OUT...

#include "apps/freevoxels/device_options.h"
#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_options.h"
#include "apps/freevoxels/timings_file.h"

namespace freevoxels {

class RenderCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;
  void draw(const Device& device, RunReport& report) const;

  SceneOptions scene_;
  MethodOptions method_;
  DeviceOptions device_;
  MessageOptions messages_;
  std::optional<std::string> timings_;
};

}  // namespace freevoxels
