// The order of the passes of a frame of splats. What is in brackets runs only if the frame needs it and it is not kept from an earlier one;
// what is before a bar is submitted on its own.
//   [blocks and octree] | [attenuation sweeps, table levels] | [light rays] | [depth sort], [cut], splats in chunks, resolve

#include "engine/splat_drawing.h"

#include <utility>

namespace freevoxels {

void SplatDrawing::preparePasses(const FrameSettings& settings) {
  if (!splats_ || !splats_->draws(settings)) {
    splats_.emplace(scene_.device, settings.depth, settings.isSorted());
    resolve_.emplace(scene_.device, settings.depth);
  }
  if (settings.isSorted() && !sort_) sort_.emplace(scene_.device, scene_.built.volume);
}

SplatDrawing::Frame SplatDrawing::prepare(Commands& commands, const Camera& camera, const FrameSettings& wanted, const Progress& progress) {
  scene_.frameTimes.clear();
  const BuiltVolume& built = scene_.builtWithBlocks(progress);
  checkSplatsFit(scene_.device, built.volume);
  Frame frame{.settings = scene_.resolved(wanted), .constants = {}, .targets = {}};
  preparePasses(frame.settings);
  FrameConstants& constants = frame.constants;
  constants = makeFrameConstants(scene_.device, built.volume, scene_.tableSettings, camera, frame.settings);
  if (constants.readsTable()) frame.table = &scene_.table(constants.readsLevels(), progress);
  frame.targets = scene_.targetPool.take(scene_.device, frame.settings, frame.settings.isSorted() ? TargetKind::Image : TargetKind::Sums);
  if (frame.settings.isSorted()) {
    sort_->record(commands, built.volume, built.visible, camera);
    frame.order = &sort_->voxels();
  }
  if (frame.settings.lighting) constants.setup.lighting = scene_.prepareLights(frame.settings, false, progress);
  CullRule& cull = constants.cull;
  if (cull.hiddenDepth > 0.0 &&
      !canHide(scene_.tableSettings, scene_.largestDepths(), glm::dmat3(built.volume.indexToWorld), cull.hiddenDepth))
    cull.hiddenDepth = 0.0;
  return frame;
}

/// The blocks to draw, without those that the table calls hidden.
SplatPass::Inputs SplatDrawing::recordList(Commands& commands, const Frame& frame) {
  const FrameConstants& constants = frame.constants;
  const BuiltVolume& built = scene_.built;
  lastWasCut_ = frame.isCut();
  lastLevel_ = constants.detail.finest;
  SplatPass::Inputs drawing{.volume = built.volume, .table = frame.table, .order = frame.order};
  if (constants.lit) drawing.lights = &scene_.lights().lights();
  if (lastWasCut_) {
    if (!cut_) cut_.emplace(scene_.device, scene_.tableSettings.code);
    cut_->record(commands, {.volume = built.volume,
                            .voxels = built.visible,
                            .lists = built.lists,
                            .table = frame.table,
                            .setup = constants.setup,
                            .detail = constants.detail,
                            .cull = constants.cull,
                            .candidates = frame.candidates});
    lastDrawn_ = &cut_->blocks();
  } else {
    lastDrawn_ = &built.lists.of(lastLevel_, built.visible);
  }
  drawing.visible = lastDrawn_;
  drawing.chunkCount = lastDrawn_->chunkCount;
  return drawing;
}

void SplatDrawing::recordSums(Commands& commands, const Frame& frame) {
  splats_->record(commands, recordList(commands, frame), frame.constants, *frame.targets);
}

std::shared_ptr<const FrameTargets> SplatDrawing::record(Commands& commands, const Frame& frame) {
  recordSums(commands, frame);
  if (!frame.settings.isSorted() || frame.settings.depth) resolve_->record(commands, frame.constants, *frame.targets);
  return frame.targets;
}

FixedSums SplatDrawing::shares(Commands& commands, Frame frame, const SharePart& part, const Progress& progress) {
  const BuiltVolume& built = scene_.built;
  if (!shares_ || shares_->hasDistance() != frame.settings.depth) shares_.emplace(scene_.device, built, frame.settings.depth);
  if (frame.isCut()) {
    const StageTimer timer(scene_.frameTimes, "choose blocks of shares");
    frame.candidates = shares_->candidates(part);
  }
  const SplatPass::Inputs drawing = recordList(commands, frame);
  return shares_->draw(commands,
                       {.splats = *splats_,
                        .drawing = drawing,
                        .mostBlocks = lastWasCut_ ? cut_->mostBlocks() : built.volume.stored[std::size_t(lastLevel_)],
                        .wholeLevel = lastWasCut_ ? std::nullopt : std::optional(lastLevel_),
                        .frame = frame.constants,
                        .targets = *frame.targets,
                        .layout = sumsLayout(built.volume, frame.constants, frame.settings)},
                       part, scene_.frameTimes, progress);
}

CutCounts SplatDrawing::counts() const {
  if (lastDrawn_ == nullptr) return {};
  if (lastWasCut_) return cut_->counts();
  CutCounts counts{.drawn = std::vector<std::uint64_t>(std::size_t(lastLevel_), 0)};
  counts.drawn.push_back(downloadBlockCount(scene_.device, *lastDrawn_));
  counts.considered = counts.drawn.back();
  return counts;
}

}  // namespace freevoxels
