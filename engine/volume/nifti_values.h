#pragma once
// Internal to the reader of NIfTI: its values, read by zlib slice by slice. ITK reads them all at once, twice, and takes files that were
// cut for whole ones.

#include <cstdint>
#include <filesystem>

#include "engine/core/stages.h"
#include "engine/volume/scan_file.h"
#include "engine/volume/scan_voxels.h"

namespace freevoxels {

/// Hands out the values of a time step as they are in the file, .nii or .nii.gz, which the header describes, to be rescaled by it. Fails
/// with ErrorKind::Input where the file is cut.
void readNiftiValues(const std::filesystem::path& file, const ScanHeader& header, int timeStep, const SampleSink& sink,
                     const Progress& progress);
/// Host memory that this takes.
std::uint64_t bytesToReadNifti(const ScanHeader& header);

}  // namespace freevoxels
