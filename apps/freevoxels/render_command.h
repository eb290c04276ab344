#pragma once
// freevoxels render IN OUT...

#include "apps/freevoxels/camera_options.h"
#include "apps/freevoxels/classification_options.h"
#include "apps/freevoxels/device_options.h"
#include "apps/freevoxels/input_options.h"
#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/output_options.h"
#include "apps/freevoxels/program.h"
#include "apps/freevoxels/timings_file.h"

namespace freevoxels {

class RenderCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;
  void draw(const Device& device, RunReport& report) const;
  OptionList resolved(const Classification& classification, const Camera& camera) const;

  InputOptions input_;
  ClassificationOptions classification_;
  CameraOptions camera_;
  MethodOptions method_;
  OutputOptions output_;
  DeviceOptions device_;
  MessageOptions messages_;
  std::optional<std::string> timings_;
};

}  // namespace freevoxels
