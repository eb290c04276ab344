#pragma once
// A gathered frame pass by pass: a test alters what one pass reads, and those after it go on
// with what it made.

#include <functional>
#include <optional>

#include "engine/gathering/gather_pass.h"
#include "engine/gathering/gather_stages.h"
#include "engine/octree/occupied_cells.h"
#include "engine/octree/volume_builder.h"
#include "engine/renderer.h"
#include "engine/validation/gather_checks.h"

namespace freevoxels::test {

struct SteppedGather : GatherOutputs {
  static constexpr VkPipelineStageFlags2 kStage = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  const Device& device;
  const Volume& source;
  Classification classification;
  std::vector<StageTime> times;
  BuiltVolume built;
  GatherPass pass;
  std::optional<GatherVolume> volume;

  /// What the checks are told that blocks are made of is not altered.
  std::function<void(const Device&, BuiltVolume&)> alterMedium;
  std::function<void(const Device&, const GatherVolume::Quads&)> alterQuads;
  /// Called with the frame before one pass reads it.
  std::function<void(shader::GatherFrame&)> alterSamples, alterStencil, alterResampling;

  SteppedGather(const Device& on, const Volume& of, const Classification& how)
      : device(on), source(of), classification(how), built(buildVolume(on, of, how, times)), pass(on) {}

  GatherStages frame(const Camera& camera, const FrameSettings& wanted) override {
    FrameSettings settings = wanted;
    if (settings.lod > 0.0f && !built.hasBlocks()) buildBlocks(device, source, classification, built, times);
    FrameConstants constants = makeFrameConstants(device, built.volume, {}, camera, settings);
    shader::GatherFrame rays = makeGatherFrame(built.volume, camera, settings, constants.detail, constants.endTransmittance);
    constants.detail.finest = rays.finest;
    const GatherVolume::Shading shading{.frame = constants,
                                        .table = nullptr,
                                        .lighting = nullptr,
                                        .lights = nullptr,
                                        .axes = {someRayHasAxis(rays, 0), someRayHasAxis(rays, 1), someRayHasAxis(rays, 2)}};
    std::vector<LevelData> medium;
    for (int level = 0; built.hasBlocks() && level <= constants.detail.coarsest; ++level)
      medium.push_back(downloadMedium(device, built.volume, level));
    if (alterMedium) alterMedium(device, built);
    const Cells met = metCells(source, classification, OccupiedCells::kEdge);
    volume.emplace(device, classification, built, met, times);  // what was altered for another frame is not kept
    volume->prepare(shading);
    run([&](Commands& commands) { volume->record(commands, shading); });
    volume->describe(rays);
    if (alterQuads) alterQuads(device, volume->quads(rays.mainAxis));

    const FrameTargets targets = makeTargets(device, settings, TargetKind::Image);
    run([&](Commands& commands) {
      for (const RenderTarget* target : targets.all())
        commands.transition(*target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, kStage, kStage);
    });
    const auto step = [&](const std::function<void(shader::GatherFrame&)>& alter, const auto& record) {
      shader::GatherFrame altered = rays;
      if (alter) alter(altered);
      run([&](Commands& commands) {
        pass.begin(commands, altered);
        record(commands, altered);
      });
    };
    step(alterSamples, [&](Commands& commands, const shader::GatherFrame& f) {
      pass.recordClear(commands, f);
      pass.recordSamples(commands, *volume, f);
    });
    step(alterStencil, [&](Commands& commands, const shader::GatherFrame& f) {
      if (!volume->hasScalars()) pass.recordStencil(commands, f);
    });
    step(alterResampling,
         [&](Commands& commands, const shader::GatherFrame& f) { pass.recordResampling(commands, f, volume->hasScalars(), targets); });
    GatherStages stages = downloadGatherStages(device, built, *volume, pass);
    stages.lattice = {.samples = rays.samples, .pitch = double(rays.pitch), .first = rays.firstSample};
    for (std::size_t level = 0; level < stages.medium.size() && level < medium.size(); ++level)
      if (stages.blocks[level].exists()) stages.medium[level] = medium[level];
    stages.image = downloadImage(device, targets);
    return stages;
  }

 private:
  template <typename Record>
  void run(const Record& record) {
    Commands commands(device);
    record(commands);
    commands.submitAndWait();
  }
};

}  // namespace freevoxels::test
