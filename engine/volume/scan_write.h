#pragma once
// Writes the scalars of a volume as a scan, for programs that read no OpenVDB files.

#include <filesystem>

#include "engine/core/stages.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// As 32-bit floats with the volume's place in the world, its coordinates being LPS millimetres. Voxels without data are NaN, or 0 where
/// the scalars are densities. Atomic (core/atomic_file.h): `progress` is told "writing the file" before, and must not throw then. Fails
/// with ErrorKind::Output.
void writeNrrd(const std::filesystem::path& file, const Volume& volume, const Progress& progress = {});  ///< .nrrd, of gzip
/// Compressed if the name ends in .gz. Fails with ErrorKind::Input for a box with an edge that NIfTI cannot say, above 32767.
void writeNifti(const std::filesystem::path& file, const Volume& volume, const Progress& progress = {});

}  // namespace freevoxels
