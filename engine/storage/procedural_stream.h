#pragma once
// Procedural volumes of any size for baked files: no more than a few chunks of them are ever in memory.

#include "engine/storage/baked_volume.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

/// `sample` is the same field, with or without temperatures, in fewer voxels (makeProcedural): what is asked of the whole volume before
/// its chunks are made, such as its range, is found in the sample. `field` must outlive the result.
StreamedVolume proceduralStream(const ProceduralField& field, const Volume& sample, const Classification& classification);

}  // namespace freevoxels
