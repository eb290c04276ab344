#pragma once
// Opening whatever a person drops onto the window or names in it.

#include <string>

#include "apps/view/view_state.h"

namespace freevoxels {

/// A volume (.vdb, .fvx, `procedural:NAME`, or the pattern of a sequence), a scene or a transfer function (.json),
/// or the light around (.exr). What is wrong with the file itself is said later, by the picture, but for a
/// scene. Fails with `state` as it was.
void openFile(ViewState& state, const std::string& file);

/// Whether it is remembered: what makes a picture by itself.
bool isWorthRemembering(const std::string& file);

}  // namespace freevoxels
