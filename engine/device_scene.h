#pragma once
// What all drawings of a volume that is on the device as a whole share. Only engine/renderer*.cpp and the drawings include it.

#include <optional>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/core/stages.h"
#include "engine/lighting/light_pass.h"
#include "engine/lighting/scattering_solver.h"
#include "engine/memory_planner.h"
#include "engine/octree/device_volume.h"
#include "engine/octree/occupied_cells.h"
#include "engine/octree/volume_builder.h"
#include "engine/scene/render_settings.h"
#include "engine/splatting/frame_constants.h"
#include "engine/splatting/frame_targets.h"
#include "engine/volume/classification.h"

namespace freevoxels {

/// A volume on the device, with what frames need of it and its lights: each is made for the first frame that needs it and kept. Refers to
/// the device and the volume, which must outlive it.
class DeviceScene {
 public:
  /// Uploads the volume. `times` are those of what was made before.
  DeviceScene(const Device& device, const Volume& hostVolume, const Classification& classification, const TableSettings& tableSettings,
              std::vector<StageTime> times, const Progress& progress);
  DeviceScene(const DeviceScene&) = delete;  // drawings refer to it
  DeviceScene& operator=(const DeviceScene&) = delete;

  const Device& device;
  const Volume& hostVolume;
  const TableSettings tableSettings;
  std::vector<StageTime> buildTimes;  ///< of what is kept for all frames
  std::vector<StageTime> frameTimes;  ///< of the last frame, with what was made for it
  Classification classification;
  BuiltVolume built;
  TargetPool targetPool;

  VolumeMemory memory() const;
  /// Goes on with another transfer function of scalars, and keeps what does not depend on it. Where there are no scalars, or too little
  /// memory for what is to be made now, returns false, and nothing changes.
  bool reclassify(const Classification& other);
  /// Another number whenever scalars have got other codes.
  int codesVersion() const { return codesVersion_; }
  /// The volume with its classified blocks, which are made if they do not exist yet.
  const BuiltVolume& builtWithBlocks(const Progress& progress = {});
  /// Where the volume has something to see.
  const OccupiedCells& occupiedCells();
  /// The attenuation table, with the levels above the voxels if a frame may look them up.
  const AttenuationTable& table(bool withLevels, const Progress& progress = {});
  /// The largest depths of the table, by direction; empty without its levels.
  const std::vector<double>& largestDepths() const { return largestDepths_; }
  /// Prepares the light of settings with lighting whose attenuation is not Auto: sets setup.lighting and scatteredRadiance of `constants`.
  void prepareLights(const FrameSettings& settings, bool scalars, FrameConstants& constants, const Progress& progress);
  /// The same without scattered light.
  void prepareOwnLights(const FrameSettings& settings, bool scalars, FrameConstants& constants, const Progress& progress);
  /// The lights of the last lit frame; only valid after prepareLights() or prepareOwnLights().
  const LightPass& lights() const { return *lights_; }
  /// Its scattered light; null if the last lit frame had none.
  const ScatteringSolver* scattered() const { return !scatters_ ? nullptr : clippedScattering_ ? &*clippedScattering_ : &*scattering_; }
  /// Submits the commands, waits for them and adds their times to those of the frame.
  void submit(Commands& commands, const Progress& progress = {});

 private:
  std::optional<CellRanges> scalarRanges_;  ///< of cells of OccupiedCells::kEdge; only with scalars
  std::optional<OccupiedCells> occupiedCells_;
  std::optional<AttenuationTable> table_;
  std::vector<double> largestDepths_;
  std::optional<LightPass> lights_;
  void solveScattering(const FrameSettings& settings, const Progress& progress);

  std::optional<ScatteringSolver> scattering_;
  std::optional<ScatteringSolver> clippedScattering_;  ///< in its place where the last frame was that of a part of the volume
  int codesVersion_ = 0;
  bool scatteringIsOld_ = false;  ///< whether it was solved for another classification
  bool scatters_ = false;  ///< whether the last frame that was lit has scattered light
};

}  // namespace freevoxels
