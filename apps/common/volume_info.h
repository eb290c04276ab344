#pragma once
// What freevoxels info says of a volume.

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/description/scene_description.h"
#include "engine/memory_planner.h"
#include "engine/volume/vdb.h"

namespace freevoxels {

/// The grids of a volume that is not baked. Reads a procedural one, and a scan. Fails as describeVdb and readScan do.
std::vector<GridInfo> gridsOf(const InputDescription& input);
/// What the header of a scan says; nothing for other volumes.
std::optional<ScanHeader> scanHeaderOf(const InputDescription& input);
/// The same for people.
std::vector<std::string> linesOf(const ScanHeader& scan);
/// The file of a baked volume, null for others. `check`: all of it is read, and refused where anything is damaged; a volume that is not
/// baked then fails with ErrorKind::Usage.
std::shared_ptr<const fvx::FvxFile> checkedBaked(const InputDescription& input, bool check);

/// Whether a grid can be drawn, and may be on a device as a whole: its voxels can be numbered.
bool canBeWhole(const GridInfo& grid);
/// The memory of a grid that may be on a device as a whole, without voxel colours; of the whole box if the occupied blocks were not
/// counted.
VolumeMemory memoryOf(const GridInfo& grid, DirectionSet directions);
/// Bytes stored for each occupied voxel with 26 directions.
double bytesPerVoxel(const GridInfo& grid);
/// The possible uses of a grid.
std::vector<std::string> usesOf(const GridInfo& grid);

/// All of this as JSON; `check` as above.
nlohmann::ordered_json volumeInfo(const InputDescription& input, bool check);

}  // namespace freevoxels
