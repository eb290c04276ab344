#pragma once
// What `render` and `turntable` are told alike, and do alike: pictures of one volume, whose table is made
// once.

#include <vector>

#include "apps/freevoxels/device_options.h"
#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_options.h"
#include "apps/freevoxels/share_group.h"
#include "apps/freevoxels/share_options.h"
#include "apps/freevoxels/timings_file.h"

namespace freevoxels {

class ProgressLine;

/// [frame]: the pictures to write it to.
using FrameFiles = std::vector<std::vector<std::string>>;

struct RenderOptions {
  SceneOptions scene;
  MethodOptions method;
  DeviceOptions device;
  MessageOptions messages;
  std::optional<std::string> timings;
  ShareOptions shares;
  /// The processes among which every frame is divided; null: this process draws alone, what `shares` says. Lives longer.
  ShareGroup* group = nullptr;

  void add(CLI::App& app);
  /// Draws as many frames of a full turn as `outputs` has, which take the place of `scene.output.files`.
  /// Refuses whatever can be refused before any work.
  void run(const FrameFiles& outputs) const;

 private:
  void check(const FrameFiles& outputs) const;
  bool leads() const { return group == nullptr || group->leads(); }
  bool drawsShares() const { return group != nullptr || shares.isGiven(); }
  FrameSettings frameSettings() const;
  void checkShares(const FrameFiles& outputs) const;
  void agree(const RunReport& report) const;
  void draw(const Device& device, const FrameFiles& outputs, RunReport& report) const;
  void drawLevel(const Device& device, const FrameFiles& outputs, int level, RunReport& report) const;
  void drawFrame(Renderer& renderer, const Scene& view, const FrameSettings& settings, const std::vector<std::string>& files,
                 const std::string& prefix, ProgressLine& line, RunReport& report) const;
  std::optional<FixedSums> drawSums(Renderer& renderer, const Camera& camera, const FrameSettings& settings,
                                    const Progress& progress, RunReport& report) const;
  Scene open(const Device& device, int level, ProgressLine& line, RunReport& report) const;
  OptionList describe(const Scene& scene) const;
  ExrOptions header(const Scene& scene, const std::vector<std::string>& files, const RunReport& report) const;
};

}  // namespace freevoxels
