// The order of the passes of a frame of splats. What is in brackets runs only if the frame needs it and it is not kept from an earlier one;
// what is before a bar is submitted on its own.
//   [blocks and octree] | [attenuation sweeps, table levels] | [light rays] | [depth sort], [cut], splats in chunks, resolve

#include "engine/splat_drawing.h"

#include "engine/core/error.h"

namespace freevoxels {

namespace {

bool isCut(const FrameConstants& constants) {
  return !constants.detail.isOneLevel() || !constants.cull.leavesNothingOut();
}

}  // namespace

void SplatDrawing::reset() {
  forget();
  shares_.reset();
  sort_.reset();
  resolve_.reset();
  splats_.reset();
  cut_.reset();
}

void SplatDrawing::preparePasses(const FrameSettings& settings) {
  if (!resolve_ || !splats_->draws(settings)) {
    resolve_.reset();
    splats_.emplace(scene_.device, settings.depth, settings.isSorted());
    resolve_.emplace(scene_.device, settings.depth);
  }
  if (settings.isSorted() && !sort_) sort_.emplace(scene_.device, scene_.built.volume);
}

SplatDrawing::Frame SplatDrawing::prepare(const Camera& camera, const FrameSettings& wanted, const Progress& progress) {
  FV_CHECK_EQ(wanted.gathers(), false);
  checkCamera(camera);
  forget();
  scene_.frameTimes.clear();
  const BuiltVolume& built = scene_.builtWithBlocks(progress);
  checkSplatsFit(scene_.device, built.volume);
  Frame frame{.camera = camera, .settings = wanted, .constants = {}, .targets = {}};
  FrameSettings& settings = frame.settings;
  if (settings.lighting) settings.lighting->attenuation = planLightAttenuation(scene_.device, built.volume, scene_.memory(), wanted);
  preparePasses(settings);
  FrameConstants& constants = frame.constants;
  constants = makeFrameConstants(scene_.device, built.volume, scene_.tableSettings, camera, settings);
  if (constants.readsTable()) frame.table = &scene_.table(constants.readsLevels(), progress);
  frame.targets = scene_.targetPool.take(scene_.device, settings, settings.isSorted() ? TargetKind::Image : TargetKind::Sums);
  if (settings.lighting) scene_.prepareLights(settings, false, constants, progress);
  CullRule& cull = constants.cull;
  if (cull.hiddenDepth > 0.0 &&
      !canHide(scene_.tableSettings, scene_.largestDepths(), glm::dmat3(built.volume.indexToWorld), cull.hiddenDepth))
    cull.hiddenDepth = 0.0;
  return frame;
}

/// The blocks to draw, without those that the table calls hidden; of a sorted frame in the order of their distances.
SplatPass::Inputs SplatDrawing::recordList(Commands& commands, const Frame& frame, const CutCandidates* candidates) {
  const FrameConstants& constants = frame.constants;
  const BuiltVolume& built = scene_.built;
  SplatPass::Inputs drawing{.volume = built.volume, .table = frame.table};
  if (constants.lit) drawing.lights = &scene_.lights().lights();
  if (frame.settings.isSorted()) {
    sort_->record(commands, built.volume, built.visible, frame.camera);
    drawing.order = &sort_->voxels();
  }
  if (isCut(constants)) {
    if (!cut_) cut_.emplace(scene_.device, scene_.tableSettings.code);
    cut_->record(commands, {.volume = built.volume,
                            .voxels = built.visible,
                            .lists = built.lists,
                            .table = frame.table,
                            .setup = constants.setup,
                            .detail = constants.detail,
                            .cull = constants.cull,
                            .candidates = candidates});
    recorded_ = Drawn{.list = &cut_->blocks(), .wholeLevel = {}};
  } else {
    const int level = constants.detail.finest;
    recorded_ = Drawn{.list = &built.lists.of(level, built.visible), .wholeLevel = level};
  }
  drawing.visible = recorded_->list;
  drawing.chunkCount = drawing.visible->chunkCount;
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

FixedSums SplatDrawing::shares(const Frame& frame, const SharePart& part, const Progress& progress) {
  FV_CHECK_EQ(frame.constants.cull.hiddenDepth, 0.0);
  const BuiltVolume& built = scene_.built;
  if (!shares_ || shares_->hasDistance() != frame.settings.depth) shares_.emplace(scene_.device, built, frame.settings.depth);
  const CutCandidates* candidates = nullptr;
  if (isCut(frame.constants)) {
    const StageTimer timer(scene_.frameTimes, "choose blocks of shares");
    candidates = shares_->candidates(part);
  }
  Commands commands(scene_.device);
  const SplatPass::Inputs drawing = recordList(commands, frame, candidates);
  const std::optional<int> level = recorded_->wholeLevel;
  return shares_->draw(commands,
                       {.splats = *splats_,
                        .drawing = drawing,
                        .mostBlocks = level ? built.volume.stored[std::size_t(*level)] : cut_->mostBlocks(),
                        .wholeLevel = level,
                        .frame = frame.constants,
                        .targets = *frame.targets,
                        .layout = sumsLayout(built.volume, frame.constants, frame.settings)},
                       part, scene_.frameTimes, progress);
}

CutCounts SplatDrawing::counts() const {
  if (!drawn_) return {};
  if (!drawn_->wholeLevel) return cut_->counts();
  CutCounts counts{.drawn = std::vector<std::uint64_t>(std::size_t(*drawn_->wholeLevel), 0)};
  counts.drawn.push_back(downloadBlockCount(scene_.device, *drawn_->list));
  counts.considered = counts.drawn.back();
  return counts;
}

}  // namespace freevoxels
