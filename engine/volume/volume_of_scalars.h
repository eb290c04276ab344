#pragma once
// Volumes from scalars in memory, for scans, the library and the Python module.

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/volume/channels.h"
#include "engine/volume/labels.h"
#include "engine/volume/sample_type.h"
#include "engine/volume/scan.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// The affine map from voxels that are `spacing` world units apart along x, y and z to the world. The centre
/// of the first voxel is at `origin`.
glm::dmat4 latticeTransform(const glm::dvec3& spacing, const glm::dvec3& origin);

/// Makes a volume from scalars (Volume::scalars) and a transform (Volume::indexToWorld). One that looks like fog (scan.h) has no data where
/// it is 0, as a file of the same densities. `noData` says which values mean no data; without it, the padding of a scan (scan.h) does.
/// `source` is what messages call the volume. `labels`: how the scalars are drawn if they are labels (labels.h); else null. Fails with
/// ErrorKind::Input if no scalar is active, or if `indexToWorld` is not finite or gives voxels no extent.
Volume volumeOfScalars(ScalarBricks scalars, const glm::dmat4& indexToWorld, const std::optional<NoData>& noData,
                       const std::string& source = "the array", const Labels* labels = nullptr);

/// The same of channels (channels.h), of whose boxes of equal sizes `values` has the scalars.
Volume volumeOfChannels(std::vector<ScalarBricks> values, const glm::dmat4& indexToWorld, const std::vector<ChannelStyle>& channels,
                        const std::string& source = "the array");

/// The same of colours (colors.h).
Volume volumeOfColors(std::vector<ScalarBricks> components, SampleType type, const glm::dmat4& indexToWorld, const std::string& source);

}  // namespace freevoxels
