#pragma once
// What tells apart volumes that are drawn differently although they have the same name.

#include <string>

#include "engine/scene/environment.h"
#include "engine/scene/holdout.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// XXH3 with 128 bits, as hexadecimal digits, of everything that a render reads from files: the volume's values and its place in the
/// world, the transfer function, and the environment, which may be null. Other options are not in it.
std::string contentHash(const Volume& volume, const Classification& classification, const Environment* environment);

/// That of a holdout.
std::string contentHash(const Holdout& holdout);

}  // namespace freevoxels
