#pragma once
// Procedural volumes of any size for baked files, with only a few chunks in memory at any time.

#include "engine/storage/baked_volume.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

/// `sample` is the same field, with or without temperatures, in fewer voxels (makeProcedural). It answers
/// what must be known of the whole volume before its chunks are made, such as its range. `field` must outlive
/// the result.
StreamedVolume proceduralStream(const ProceduralField& field, const Volume& sample, const Classification& classification);

}  // namespace freevoxels
