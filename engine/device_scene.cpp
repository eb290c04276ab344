#include "engine/device_scene.h"

#include <utility>

#include "engine/attenuation/table_levels.h"

namespace freevoxels {

DeviceScene::DeviceScene(const Device& onDevice, const Volume& volume, const Classification& classes, const TableSettings& settings,
                         std::vector<StageTime> times, const Progress& progress)
    : device(onDevice),
      hostVolume(volume),
      tableSettings(settings),
      buildTimes(std::move(times)),
      classification(classes),
      built(buildVolume(device, hostVolume, classification, buildTimes, progress)) {}

VolumeMemory DeviceScene::memory() const {
  const DeviceVolume& volume = built.volume;
  const std::vector<std::uint64_t> nothing(volume.hierarchy.levels.size(), 0);
  return volumeMemory(volume.hierarchy, built.hasBlocks() ? volume.stored : nothing, tableSettings.directions, storedKinds(volume),
                      sweepStyle(device));
}

bool DeviceScene::reclassify(const Classification& other) {
  if (!built.volume.scalarBricks || !other.isPost(hostVolume)) return false;
  const TransferFunction& function = *other.transferFunction;
  const double extinctionScale = kStoredDepth * built.volume.voxelSize;
  std::optional<DeviceVolume> withoutBlocks;
  std::optional<DeviceScalars> otherScalars;
  try {
    if (built.hasBlocks()) withoutBlocks = makeDeviceVolume(device, hostVolume, other);
    if (!built.volume.scalarBricks->reclassify(device, hostVolume, function, extinctionScale)) {
      otherScalars = uploadScalars(device, hostVolume, function, extinctionScale);
      ++codesVersion_;
    }
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::OutOfMemory) throw;
    return false;
  }
  // Nothing fails from here on.
  if (otherScalars) built.volume.scalarBricks = std::move(otherScalars);
  if (withoutBlocks) {
    withoutBlocks->scalarBricks = std::move(built.volume.scalarBricks);
    built = {.volume = *std::move(withoutBlocks)};
  }
  classification = other;
  occupiedCells_.reset();
  table_.reset();
  largestDepths_.clear();
  if (lights_) lights_->outdate();
  if (scattering_ && !scattering_->isSolved()) scattering_.reset();
  scatteringIsOld_ = scattering_.has_value();
  return true;
}

const BuiltVolume& DeviceScene::builtWithBlocks(const Progress& progress) {
  if (!built.hasBlocks()) buildBlocks(device, hostVolume, classification, built, frameTimes, progress);
  return built;
}

const OccupiedCells& DeviceScene::occupiedCells() {
  if (!occupiedCells_) {
    const StageTimer timer(frameTimes, "cells");
    if (built.volume.scalarBricks) {
      if (!scalarRanges_) scalarRanges_ = scalarRanges(hostVolume, OccupiedCells::kEdge);
      occupiedCells_.emplace(device, metCells(*scalarRanges_, hostVolume, *classification.transferFunction));
    } else {
      occupiedCells_.emplace(device, metCells(hostVolume, classification, OccupiedCells::kEdge));
    }
  }
  return *occupiedCells_;
}

const AttenuationTable& DeviceScene::table(bool withLevels, const Progress& progress) {
  if (!table_) {
    builtWithBlocks(progress);
    checkTableFits(device, built.volume, tableSettings.directions);
    AttenuationTable made = makeTable(device, built.volume, tableSettings);
    AttenuationSweep sweep(device, tableSettings);
    Commands commands(device);
    sweep.record(commands, built.volume, made);
    submit(commands, progress);
    table_ = std::move(made);
  }
  if (withLevels && largestDepths_.empty()) {
    TableLevels pass(device, tableSettings);
    Commands commands(device);
    pass.record(commands, built.volume, built.lists.steps, *table_);
    submit(commands, progress);
    largestDepths_ = downloadLargestDepths(device, *table_);
  }
  return *table_;
}

/// Solves for the scattered light, unless that is there or may be old.
void DeviceScene::solveScattering(const FrameSettings& settings, const Progress& progress) {
  if (!settings.clip) clippedScattering_.reset();
  if (scatteringIsOld_ && settings.allowsOldLight) return;
  std::optional<ScatteringSolver> other;  // the old light stays until this is complete, for a draft that follows if it is given up
  if (!scattering_ || scatteringIsOld_) {
    const StageTimer timer(frameTimes, "scattering medium");
    other.emplace(device, ScatteringMedium(hostVolume, classification));
  }
  ScatteringSolver& solver = other ? *other : *scattering_;
  if (settings.clip) {
    ScatteringSolver clipped = solver.clipped(*settings.clip, settings.scatteringCoarseness);
    clipped.solve(*settings.lighting, 0, frameTimes, progress);
    clippedScattering_.reset();
    clippedScattering_.emplace(std::move(clipped));
  } else {
    solver.solve(*settings.lighting, settings.scatteringCoarseness, frameTimes, progress);
  }
  if (other) {
    scattering_.reset();
    scattering_.emplace(*std::move(other));
  }
  scatteringIsOld_ = false;
}

void DeviceScene::prepareLights(const FrameSettings& settings, bool scalars, FrameConstants& constants, const Progress& progress) {
  // First, as a solution takes memory while it is computed.
  scatters_ = hasScatteredLight(*settings.lighting, built.volume.hasEmission());
  if (scatters_) solveScattering(settings, progress);
  prepareOwnLights(settings, scalars, constants, progress);
  if (scatters_) setScattered(constants, *settings.lighting, *scattered());
}

void DeviceScene::prepareOwnLights(const FrameSettings& settings, bool scalars, FrameConstants& constants, const Progress& progress) {
  if (!lights_) lights_.emplace(device);
  const OccupiedCells* const cells = settings.lighting->attenuation == LightAttenuation::Exact ? &occupiedCells() : nullptr;
  constants.setup.lighting = lights_->prepare(built.volume, tableSettings, settings, scalars, cells, frameTimes, progress);
}

void DeviceScene::submit(Commands& commands, const Progress& progress) {
  commands.submitAndWait(progress);
  addTimes(frameTimes, commands.times());
}

}  // namespace freevoxels
