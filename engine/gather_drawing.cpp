// The order of the passes of a gathered frame. What is in brackets runs only if the frame needs it and it is not kept from an earlier one;
// what is before a bar is submitted on its own.
//   [blocks and octree] | [attenuation sweeps, table levels] | [light rays] | [shaded blocks, light depths, gradients, quads] |
//   gather, stencil, resampling and resolve

#include "engine/gather_drawing.h"

#include <utility>

#include "engine/core/error.h"
#include "engine/gathering/gather_rows.h"
#include "engine/splatting/accumulate_pass.h"

namespace freevoxels {

/// The volume with room for what the frame needs. One that has followed other functions may have more bricks than this one needs: where
/// there is not enough memory for it, it is made anew.
void GatherDrawing::followScene(const GatherVolume::Shading& shading) {
  const Cells& met = scene_.occupiedCells().met();
  if (std::exchange(codesVersion_, scene_.codesVersion()) != scene_.codesVersion()) volume_.reset();
  const bool mayBeLarge = volume_.has_value();
  try {
    if (!volume_)
      volume_.emplace(scene_.device, scene_.classification, scene_.built, met, scene_.frameTimes);
    else if (isOld_)
      volume_->reclassify(met, scene_.frameTimes);
    isOld_ = false;
    volume_->prepare(shading);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::OutOfMemory || !mayBeLarge) throw;
    volume_.reset();
    volume_.emplace(scene_.device, scene_.classification, scene_.built, met, scene_.frameTimes);
    volume_->prepare(shading);
  }
}

void GatherDrawing::prepareVolume(const GatherVolume::Shading& shading, const shader::GatherFrame& lattice, const Progress& progress) {
  try {
    followScene(shading);
    GatherPass::compileAhead(scene_.device, *volume_, shading.axes, GatherPass::Rays(lattice));
  } catch (...) {
    volume_.reset();
    throw;
  }
  const GatherVolume::State before = volume_->state();
  try {
    Commands commands(scene_.device);
    volume_->record(commands, shading);
    if (!commands.empty()) scene_.submit(commands, progress);
  } catch (...) {
    volume_->restore(before);
    throw;
  }
}

GatherDrawing::Frame GatherDrawing::prepare(const Camera& camera, const FrameSettings& wanted, const Progress& progress) {
  FV_CHECK_EQ(wanted.gathers(), true);
  checkCamera(camera);
  scene_.frameTimes.clear();
  Frame frame{.settings = wanted, .constants = {}, .lattice = {}};
  FrameSettings& settings = frame.settings;
  // Whatever memory there is: a frame that lacks it for exact shadows is drawn cube by cube.
  if (settings.lighting) settings.lighting->attenuation = lightAttenuationFor(wanted);
  const Lighting* const lighting = settings.lighting ? &*settings.lighting : nullptr;
  const bool lightsSamples = GatherVolume::lightsSamples(lighting);
  const bool shadesVoxels = lighting != nullptr && !lightsSamples;
  const DeviceVolume& onDevice = scene_.built.volume;
  const auto constantsNow = [&] { return makeFrameConstants(scene_.device, onDevice, scene_.tableSettings, camera, settings); };
  FrameConstants& constants = frame.constants = constantsNow();
  frame.lattice = makeGatherFrame(onDevice, camera, settings, constants.detail, constants.endTransmittance);
  if ((shadesVoxels || frame.lattice.coarsest > 0) && !scene_.built.hasBlocks()) {
    scene_.builtWithBlocks(progress);
    constants = constantsNow();  // with the blocks' addresses
  }
  constants.detail.finest = frame.lattice.finest;
  constants.detail.coarsest = frame.lattice.coarsest;
  const bool readsTable = constants.lightsReadTable && !lightsSamples;
  const AttenuationTable* const table = readsTable ? &scene_.table(constants.detail.coarsest > 0, progress) : nullptr;
  if (lighting != nullptr) scene_.prepareLights(settings, onDevice.scalarBricks.has_value() && lightsSamples, constants, progress);
  prepareVolume({.frame = constants,
                 .table = table,
                 .lighting = lighting,
                 .lights = lighting != nullptr ? &scene_.lights() : nullptr,
                 .scattered = lighting != nullptr ? scene_.scattered() : nullptr,
                 .axes = {someRayHasAxis(frame.lattice, 0), someRayHasAxis(frame.lattice, 1), someRayHasAxis(frame.lattice, 2)},
                 .keptQuadBytes = planKeptQuadBytes(scene_.device)},
                frame.lattice, progress);
  if (!pass_) pass_.emplace(scene_.device);
  frame.lattice.holdout = pass_->holdOut(settings.holdout);
  volume_->describe(frame.lattice);
  return frame;
}

std::shared_ptr<const FrameTargets> GatherDrawing::record(Commands& commands, const Frame& frame) {
  std::shared_ptr<const FrameTargets> targets = scene_.targetPool.take(scene_.device, frame.settings, TargetKind::Image);
  pass_->record(commands, *volume_, frame.lattice, *targets);
  return targets;
}

FixedSums GatherDrawing::shares(const Frame& frame, const SharePart& part, const Progress& progress) {
  FixedSums sums = sumsOfSamples(frame.lattice, volume_->hasScalars(), sumsLayout(scene_.built.volume, frame.constants, frame.settings));
  const glm::ivec2 rows = rowsOfPart(frame.lattice, part);
  if (rows.x == rows.y) return sums;
  const shader::GatherFrame own = frameOfRows(frame.lattice, rows);
  Commands commands(scene_.device);
  commands.beginPass("gather");
  pass_->begin(commands, own);
  pass_->recordSamples(commands, *volume_, own);
  scene_.submit(commands, progress);
  const StageTimer timer(scene_.frameTimes, "copy to host");
  addSamples(sums, pass_->downloadRows(rows), rows);
  return sums;
}

}  // namespace freevoxels
