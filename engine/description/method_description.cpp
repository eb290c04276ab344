#include "engine/core/error.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

TableSettings MethodDescription::table() const {
  return {.code = code.value_or(paper ? AttenuationCode::Linear8 : AttenuationCode::Depth8),
          .pathLengthCorrection = pathLengthCorrection.value_or(!paper),
          .directions = directions.value_or(DirectionSet::Directions26),
          .filter = hierarchyFilter.value_or(HierarchyFilter::Geometric)};
}

void MethodDescription::apply(FrameSettings& frame) const {
  frame.draw = draw.value_or(Draw::Auto);
  frame.composite = composite.value_or(paper ? Composite::Additive : Composite::Normalised);
  frame.attenuation = attenuation.value_or(paper ? AttenuationLookup::Nearest : AttenuationLookup::Auto);
  if (frame.draw == Draw::Gather && !canGather(frame))
    fail(ErrorKind::Usage, "{} computes exact transmittance and no sorted image: leave {} and {} out, or use {}",
         Parameter("draw", "gather"), Parameter("attenuation"), Parameter("composite"), Parameter("draw", "splats"));
  frame.gradient = gradient.value_or(!paper);
  frame.lod = float(lod.value_or(paper ? 0.0 : 1.0));
  frame.culling = culling.value_or(!paper);
  frame.cullThreshold = float(cullThreshold.value_or(double(frame.cullThreshold)));
}

}  // namespace freevoxels
