#pragma once
// Opens files that are dropped onto the window or named in it.

#include <string>

#include "apps/view/view_state.h"

namespace freevoxels {

/// A volume (.vdb, .fvx, `procedural:NAME`, or the pattern of a sequence), a scene or a transfer function (.json),
/// or the light around (.exr). What is wrong with the file itself is said later, by the image, but for a
/// scene. Fails with `state` as it was.
void openFile(ViewState& state, const std::string& file);

/// Whether it is added to recent files: files that make an image on their own.
bool isWorthRemembering(const std::string& file);

}  // namespace freevoxels
