#pragma once
// Writes the values of a volume, as they are before they are classified, into a file of another format.

#include <functional>
#include <string>

#include "engine/description/scene_description.h"

namespace freevoxels {

/// Fails where it can be refused before any work: for a name that is of no format that is written, for one that cannot be written, or that
/// is the input itself.
void checkConvert(const InputDescription& input, const std::string& file);

/// Told of each volume that was read, by the thread that converts.
using ConvertRemarks = std::function<void(const Volume& volume)>;

/// Reads the volume and writes .vdb, .nrrd, .nii or .nii.gz, with its place in the world. The channels of a scan become grids of a .vdb; of
/// other formats one is chosen by the input's grid. `progress` may abandon reading. Fails as InputDescription::open does, for baked volumes
/// that have been classified for good, and with ErrorKind::Output.
void convertVolume(const InputDescription& input, const std::string& file, const ConvertRemarks& remarks, const Progress& progress);

}  // namespace freevoxels
