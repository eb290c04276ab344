#pragma once
// The stages pass by pass, with everything between them open: a test breaks one, and those after it go on
// with what it made, as they would after the real bug.

#include <functional>
#include <utility>

#include "engine/attenuation/ray_sweep.h"
#include "engine/octree/medium_levels.h"
#include "engine/octree/occupancy.h"
#include "engine/reference/reference_splats.h"
#include "engine/validation/stage_outputs.h"
#include "engine/validation/stepped_renderer.h"

namespace freevoxels::test {

struct SteppedStages : StageOutputs {
  const Device& device;
  Volume source;
  SteppedVolume steps;
  std::vector<std::uint32_t> listed;         ///< what the list of visible voxels says, padded
  std::vector<std::uint32_t> drawn;          ///< what is drawn, padded
  std::function<void(RayCodes&)> alterRays;  ///< of what the checks see: a frame sweeps its own
  std::function<Image(const std::vector<SplatSums>&, const FrameSettings&)> resolve = referenceResolve;

  SteppedStages(const Device& on, Volume volume, const Classification& classification,
                const TableSettings& table)
      : device(on),
        source(std::move(volume)),
        steps(prepareSteps(device, source, classification, table)),
        listed(steps.voxels),
        drawn(steps.voxels) {}

  std::vector<float> extinction() override {
    const LevelData voxels = downloadMedium(device, steps.volume, 0);
    return {voxels.extinction.begin(), voxels.extinction.end()};
  }
  std::vector<glm::dvec3> emission() override { return downloadMedium(device, steps.volume, 0).emission; }
  TableBytes table() override { return downloadTable(device, steps.volume, steps.table); }
  std::vector<std::uint32_t> visibleVoxels() override {
    std::vector<std::uint32_t> voxels;
    for (const std::uint32_t voxel : listed) voxels.push_back(steps.volume.layout.unpaddedIndex(voxel));
    return voxels;
  }
  RayCodes rays(const RaySource& from) override {
    RaySweep sweep(device);
    RayCodes codes = sweep.sweep(steps.volume, from);
    if (alterRays) alterRays(codes);
    return codes;
  }
  std::vector<SplatSums> sums(const Camera& camera, const FrameSettings& settings) override {
    return drawVoxels(device, steps, drawn, camera, settings);
  }
  Image image(const Camera& camera, const FrameSettings& settings) override { return resolve(sums(camera, settings), settings); }

  /// In the order of Volume::values.
  void replacePlane(int direction, const std::vector<std::uint8_t>& bytes) {
    std::vector<std::uint8_t> stored;
    for (const std::uint32_t voxel : downloadStored(device, steps.volume, 0)) stored.push_back(bytes[voxel]);
    upload(device, steps.table.planes[std::size_t(direction)], std::as_bytes(std::span(stored)));
  }
};

}  // namespace freevoxels::test
