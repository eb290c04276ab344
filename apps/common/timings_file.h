#pragma once
// The report of a run, for --verbose and for --timings FILE.json.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "apps/common/option_values.h"
#include "engine/core/stages.h"
#include "engine/description/scene_description.h"
#include "engine/renderer.h"
#include "engine/visibility/cut_pass.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

struct RunReport {
  SceneDescription scene;   ///< as it was resolved for the first volume
  OptionList options;       ///< the same, as far as the command has them
  std::string contentHash;  ///< content_hash.h, of a run that draws shares
  DeviceDescription device;
  std::vector<StageTime> stages;
  double totalMilliseconds = 0.0;
  std::optional<std::uint64_t> visibleVoxels;  ///< Renderer::occupiedVoxelCount
  std::uint64_t voxels = 0;                    ///< number of voxels of the volume's box
  VolumeMemory memory;
  std::uint64_t devicePeak = 0;    ///< largest number of bytes allocated on the device at any time
  CutCounts cut;                   ///< cut of the last frame
  std::optional<ScatteringFacts> scattering;  ///< of the last frame
};

/// Prints the messages of --verbose.
void logOptions(const OptionList& options);
void logStages(const RunReport& report);

/// {"version", "device": {"name", "type", "uuid", "driver"}, "options": {NAME: VALUE},
///  "stages": [{"name", "milliseconds", "on_device"}], "voxels", "visible_voxels" (where they were counted),
///  "memory_bytes": {"stored", "peak"},
///  "scattering" (with such light): {"cells", "cell_edge", "sets", "residual"},
///  "blocks": {"considered", "empty", "outside", "hidden", "opened", "drawn": [by level, voxels first]},
///  "total_milliseconds"}.
/// Atomic.
void writeTimings(const std::filesystem::path& file, const RunReport& report);

}  // namespace freevoxels
