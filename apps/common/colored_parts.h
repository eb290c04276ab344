#pragma once
// An image in which every voxel has the colour of the part that draws it: Subr et al. 2007, Figure 5.

#include "engine/core/stages.h"
#include "engine/image/fixed_sums.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"

namespace freevoxels {

class Renderer;

/// The colour of a part, linear Rec.709: hues that are apart for consecutive parts, the same for any number of parts.
glm::dvec3 partColor(int part);

/// The sums of all shares, drawn as `parts` parts one after the other. The light of each part has the part's colour and keeps its
/// luminance, so that lighting and shadows remain visible. 1 <= parts <= kShares.
FixedSums drawColoredParts(Renderer& renderer, const Camera& camera, const FrameSettings& settings, int parts, const Progress& progress);

}  // namespace freevoxels
