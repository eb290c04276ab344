#pragma once
// Opens files that are dropped onto the window or named in it.

#include <filesystem>
#include <string>
#include <vector>

#include "apps/view/view_state.h"

namespace freevoxels {

/// A volume (.vdb, .fvx, `procedural:NAME`, the pattern of a sequence, or a folder of slices or of OpenVDB files, of which the first or its
/// sequence is opened), a scene or a transfer function (.json), or the light around (.exr). What is wrong with the file itself is said
/// later, by the image, but for a scene. Fails with `state` as it was.
void openFile(ViewState& state, const std::string& opened);

/// Whether it is added to recent files: files that make an image on their own.
bool isWorthRemembering(const std::string& file);

/// Whether a name ends in one of these, which are in lower case, whatever its own case.
bool hasEnding(const std::filesystem::path& file, const std::vector<std::string>& endings);
/// Whether files that are numbered as it is may be the frames of a sequence: those of DICOM are slices of a volume.
bool mayBeFrame(const std::filesystem::path& file);

}  // namespace freevoxels
