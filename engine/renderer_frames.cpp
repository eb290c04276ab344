// The stages of a frame: what it needs and does not have yet is made, then its image or its sums are recorded.
//
// The order of the passes. What is in brackets runs only if the frame needs it and it is not kept from an earlier one; what is before a bar
// is submitted on its own.
//   gathered:  [blocks and octree] | [attenuation sweeps, table levels] | [light rays] | [shaded blocks, light depths, gradients, quads] |
//              gather, stencil, resampling and resolve
//   splatted:  [blocks and octree] | [attenuation sweeps, table levels] | [light rays] | [depth sort], [cut], eye rays and splats in
//   chunks,
//              [cut of deferred blocks, their splats], resolve

#include <algorithm>

#include "engine/core/error.h"
#include "engine/renderer_state.h"

namespace freevoxels {

VolumeMemory Renderer::State::memoryOfVolume() const {
  const DeviceVolume& volume = built.volume;
  const std::vector<std::uint64_t> nothing(volume.hierarchy.levels.size(), 0);
  return volumeMemory(volume.hierarchy, built.hasBlocks() ? volume.stored : nothing, tableSettings.directions, storedKinds(volume),
                      sweepStyle(device));
}

/// Makes the blocks when a frame first needs them; their time is part of that frame's.
const BuiltVolume& Renderer::State::builtWithBlocks(const Progress& progress) {
  if (!built.hasBlocks()) buildBlocks(device, hostVolume, classification, built, frameTimes, progress);
  return built;
}

/// Makes the table when a frame first reads it; its time is part of that frame's.
const AttenuationTable& Renderer::State::sweptTable(const Progress& progress) {
  if (table) return *table;
  builtWithBlocks(progress);
  checkTableFits(device, built.volume, tableSettings.directions);
  AttenuationTable made = makeTable(device, built.volume, tableSettings);
  AttenuationSweep sweep(device, tableSettings);
  Commands commands(device);
  sweep.record(commands, built.volume, made);
  commands.submitAndWait(progress);
  addTimes(frameTimes, commands.times());
  return table.emplace(std::move(made));
}

/// Makes the table's levels when a frame may first draw a block.
const AttenuationTable& Renderer::State::tableWithLevels(const Progress& progress) {
  sweptTable(progress);
  if (!largestDepths.empty()) return *table;
  TableLevels pass(device, tableSettings);
  Commands commands(device);
  pass.record(commands, built.volume, built.lists.steps, *table);
  commands.submitAndWait(progress);
  addTimes(frameTimes, commands.times());
  largestDepths = downloadLargestDepths(device, *table);
  return *table;
}

CutInputs Renderer::State::cutInputs(const Splatting& frame) const {
  return {.volume = built.volume,
          .voxels = built.visible,
          .lists = built.lists,
          .table = frame.table,
          .setup = frame.constants.setup,
          .rays = frame.constants.resolve,
          .detail = frame.constants.detail,
          .cull = frame.constants.cull,
          .candidates = frame.candidates};
}

/// The blocks to draw, without those that the table calls hidden.
SplatPass::Inputs Renderer::State::recordList(Commands& commands, const Splatting& frame) {
  const FrameConstants& constants = frame.constants;
  lastWasCut = frame.isCut();
  lastLevel = constants.detail.finest;
  SplatPass::Inputs drawing{.volume = built.volume, .table = frame.table, .order = frame.order};
  if (constants.lit) drawing.lights = &lights->lights();
  if (lastWasCut) {
    if (!cutter) cutter.emplace(device, tableSettings.code);
    cutter->record(commands, cutInputs(frame));
    lastDrawn = &cutter->blocks();
  } else {
    lastDrawn = &built.lists.of(lastLevel, built.visible);
  }
  drawing.visible = lastDrawn;
  drawing.chunkCount = lastWasCut ? lastDrawn->chunkCount / 2 : lastDrawn->chunkCount;
  return drawing;
}

/// Records the splats of a frame. Blocks that the table calls hidden follow after the others, where pixels
/// are not covered.
void Renderer::State::recordDrawing(Commands& commands, const Splatting& frame) {
  SplatPass::Inputs drawing = recordList(commands, frame);
  splats->record(commands, drawing, frame.constants, *frame.targets);
  if (frame.constants.cull.hiddenDepth == 0.0) return;
  cutter->recordDeferred(commands, cutInputs(frame), frame.targets->colorEnergy, frame.targets->opticalDepth);
  drawing.firstChunk = drawing.chunkCount;
  drawing.continued = drawing.sameFrame = true;
  splats->record(commands, drawing, frame.constants, *frame.targets);
}

/// Resolves LightAttenuation::Auto.
FrameSettings Renderer::State::resolved(const FrameSettings& settings) {
  FrameSettings result = settings;
  if (!settings.lighting) return result;
  if (!lights) lights.emplace(device);
  result.lighting->attenuation = planLightAttenuation(device, built.volume, memoryOfVolume(), settings);
  return result;
}

/// Auto uses the table alone if there is not enough memory for rays from the eye.
FrameConstants Renderer::State::constantsOf(const Camera& camera, const FrameSettings& settings,
                                            const Progress& progress) {
  lastLackedRays = false;
  const FrameConstants constants = makeFrameConstants(device, built.volume, tableSettings, camera, settings);
  if (!constants.readsRays()) return constants;
  if (constants.readsTable()) sweptTable(progress);  // allocated first, as it is indispensable
  try {
    splats->makeRoomForRays(built.volume, constants.eye,
                            planEyeRayBytes(device, built.volume, memoryOfVolume(), settings, constants.readsTable()));
    return constants;
  } catch (const Error& error) {
    if (!tableReplacesEyeRays(settings, error)) throw;
  }
  lastLackedRays = true;
  FrameSettings tableAlone = settings;
  tableAlone.attenuation = AttenuationLookup::Bilinear;
  return makeFrameConstants(device, built.volume, tableSettings, camera, tableAlone);
}

/// All that a frame of splats needs before its blocks are listed and drawn.
Renderer::State::Splatting Renderer::State::prepareSplats(Commands& commands, const Camera& camera, const FrameSettings& wanted,
                                                          const Progress& progress) {
  frameTimes.clear();
  builtWithBlocks(progress);
  checkSplatsFit(device, built.volume);
  const FrameSettings settings = resolved(wanted);
  const bool sorted = settings.composite == Composite::Sorted;
  if (!splats || !splats->draws(settings)) {
    splats = std::make_unique<SplatPass>(device, settings.depth, sorted);
    resolve = std::make_unique<ResolvePass>(device, settings.depth);
  }
  if (sorted && !sort) sort = std::make_unique<DepthSort>(device, built.volume);
  Splatting frame{.constants = constantsOf(camera, settings, progress),
                  .targets = targetPool.take(device, settings, sorted ? TargetKind::Image : TargetKind::Sums)};
  if (sorted) {
    sort->record(commands, built.volume, built.visible, camera);
    frame.order = &sort->voxels();
  }
  if (frame.constants.readsTable())
    frame.table = frame.constants.readsLevels() ? &tableWithLevels(progress) : &sweptTable(progress);
  if (settings.lighting)
    frame.constants.setup.lighting = lights->prepare(built.volume, tableSettings, settings, false, frameTimes, progress);
  CullRule& cull = frame.constants.cull;
  if (cull.hiddenDepth > 0.0 &&
      !canHide(tableSettings, largestDepths, glm::dmat3(built.volume.indexToWorld), cull.hiddenDepth))
    cull.hiddenDepth = 0.0;
  return frame;
}

/// Records a frame up to the sums in the targets; for Sorted these are the image.
Renderer::State::Splatting Renderer::State::recordSplats(Commands& commands, const Camera& camera, const FrameSettings& settings,
                                                         const Progress& progress) {
  Splatting frame = prepareSplats(commands, camera, settings, progress);
  recordDrawing(commands, frame);
  return frame;
}

/// What the gather keeps of the volume for further frames is made by a submission of its own, so that a frame that is
/// abandoned while its image is drawn leaves it complete.
void Renderer::State::prepareVolume(const GatherVolume::Shading& shading, const Progress& progress) {
  try {
    if (!gatherVolume) gatherVolume.emplace(device, hostVolume, classification, built, frameTimes);
    gatherVolume->prepare(shading, frameTimes);
    GatherPass::compileAhead(device, *gatherVolume, shading.axes, shading.frame.detail.coarsest > 0);
    Commands commands(device);
    gatherVolume->record(commands, shading);
    if (commands.empty()) return;
    commands.submitAndWait(progress);
    addTimes(frameTimes, commands.times());
  } catch (...) {
    gatherVolume.reset();
    throw;
  }
}

/// All that a gathered frame needs before its samples are marched.
Renderer::State::Gathering Renderer::State::prepareGather(const Camera& camera, const FrameSettings& wanted, const Progress& progress) {
  frameTimes.clear();
  lastDrawn = nullptr;
  lastLackedRays = false;
  Gathering frame{.settings = resolved(wanted), .constants = {}, .lattice = {}};
  FrameSettings& settings = frame.settings;
  FrameConstants& constants = frame.constants;
  settings.attenuation = AttenuationLookup::Exact;
  constants = makeFrameConstants(device, built.volume, tableSettings, camera, settings);
  const bool lightsSamples = GatherVolume::lightsSamples(settings.lighting ? &*settings.lighting : nullptr);
  const bool shadesVoxels = settings.lighting && !lightsSamples;
  if ((shadesVoxels || constants.detail.coarsest > 0) && !built.hasBlocks()) {
    builtWithBlocks(progress);
    constants = makeFrameConstants(device, built.volume, tableSettings, camera, settings);
  }
  frame.lattice = makeGatherFrame(built.volume, camera, settings, constants.detail, constants.hiddenTransmittance);
  constants.detail.finest = frame.lattice.finest;
  const bool ofScalars = built.volume.scalarBricks.has_value() && lightsSamples;
  const AttenuationTable* read = nullptr;
  if (constants.lightsReadTable && !lightsSamples)
    read = constants.detail.coarsest > 0 ? &tableWithLevels(progress) : &sweptTable(progress);
  if (settings.lighting)
    constants.setup.lighting = lights->prepare(built.volume, tableSettings, settings, ofScalars, frameTimes, progress);
  prepareVolume({.frame = constants,
                 .table = read,
                 .lighting = settings.lighting ? &*settings.lighting : nullptr,
                 .lights = settings.lighting ? &*lights : nullptr,
                 .axes = {someRayHasAxis(frame.lattice, 0), someRayHasAxis(frame.lattice, 1), someRayHasAxis(frame.lattice, 2)},
                 .keptQuadBytes = planKeptQuadBytes(device)},
                progress);
  if (!gather) gather.emplace(device);
  gatherVolume->describe(frame.lattice);
  return frame;
}

/// Reads the image in the targets, without their optical depth.
std::shared_ptr<const FrameTargets> Renderer::State::recordGather(Commands& commands, const Camera& camera, const FrameSettings& wanted,
                                                                  const Progress& progress) {
  const Gathering frame = prepareGather(camera, wanted, progress);
  const std::shared_ptr<const FrameTargets> targets = targetPool.take(device, frame.settings, TargetKind::Image);
  gather->record(commands, *gatherVolume, frame.lattice, *targets);
  return targets;
}

FixedSums Renderer::State::gatherShares(const Camera& camera, const FrameSettings& settings, const SharePart& part,
                                        const Progress& progress) {
  const Gathering frame = prepareGather(camera, settings, progress);
  FixedSums sums = sumsOfSamples(frame.lattice, gatherVolume->hasScalars(), sumsLayout(built.volume, frame.constants, frame.settings));
  const glm::ivec2 rows = rowsOfPart(frame.lattice, part);
  if (rows.x == rows.y) return sums;
  const shader::GatherFrame own = frameOfRows(frame.lattice, rows);
  Commands commands(device);
  gather->begin(commands, own);
  commands.beginPass("gather");
  gather->recordSamples(commands, *gatherVolume, own);
  commands.submitAndWait(progress);
  addTimes(frameTimes, commands.times());
  const StageTimer timer(frameTimes, "copy to host");
  addSamples(sums, gather->downloadGathered(), rows);
  return sums;
}

FixedSums Renderer::State::splatShares(const Camera& camera, const FrameSettings& settings, const SharePart& part,
                                       const Progress& progress) {
  Commands commands(device);
  Splatting frame = prepareSplats(commands, camera, settings, progress);
  if (!shares || shares->hasDistance() != settings.depth) shares = std::make_unique<ShareDrawing>(device, built, settings.depth);
  if (frame.isCut()) {
    const StageTimer timer(frameTimes, kChoosingShares);
    frame.candidates = shares->candidates(part);
  }
  const SplatPass::Inputs drawing = recordList(commands, frame);
  const std::uint64_t mostBlocks = lastWasCut ? cutter->mostBlocks() : built.volume.stored[std::size_t(lastLevel)];
  FixedSums layout = sumsLayout(built.volume, frame.constants, settings);
  const std::optional<int> wholeLevel = lastWasCut ? std::nullopt : std::optional(lastLevel);
  return shares->draw(commands, {*splats, drawing, mostBlocks, wholeLevel, frame.constants, *frame.targets, std::move(layout)}, part,
                      frameTimes, progress);
}

std::shared_ptr<const FrameTargets> Renderer::State::recordImage(Commands& commands, const Camera& camera, const FrameSettings& settings,
                                                                 const Progress& progress) {
  if (drawsByGathering(settings)) return recordGather(commands, camera, settings, progress);
  Splatting frame = recordSplats(commands, camera, settings, progress);
  if (settings.composite != Composite::Sorted || settings.depth) resolve->record(commands, frame.constants, *frame.targets);
  return frame.targets;
}

}  // namespace freevoxels
