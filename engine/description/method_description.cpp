#include "engine/core/error.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

namespace {

constexpr double kCoarseLightBelow = 0.5;  // quality

}  // namespace

TableSettings MethodDescription::table() const {
  return {.code = code.value_or(paper ? AttenuationCode::Linear8 : AttenuationCode::Depth8),
          .pathLengthCorrection = pathLengthCorrection.value_or(!paper),
          .directions = directions.value_or(DirectionSet::Directions26),
          .filter = hierarchyFilter.value_or(HierarchyFilter::Geometric)};
}

bool MethodDescription::hasOptionsOfSplats() const {
  return paper || attenuation || composite.value_or(Composite::Normalised) != Composite::Normalised;
}

Draw MethodDescription::drawing() const {
  return draw.value_or(hasOptionsOfSplats() ? Draw::Splats : Draw::Gather);
}

void MethodDescription::apply(FrameSettings& frame) const {
  frame.lod = float(lod.value_or(paper || isProjected() ? 0.0 : 1.0));
  frame.quality = quality.value_or(1.0);
  frame.scatteringCoarseness = frame.quality < kCoarseLightBelow ? 1 : 0;
  if (isProjected() && frame.lod > 0.0f)
    fail(ErrorKind::Usage, "{} shows the values of voxels, not of levels of detail: leave {} out", Parameter("mode"), Parameter("lod"));
  if (drawing() == Draw::Gather) {
    if (hasOptionsOfSplats())
      fail(ErrorKind::Usage, "{} computes exact transmittance and has nothing of the paper's method: leave {}, {} and {} out, or use {}",
           Parameter("draw", "gather"), Parameter("paper"), Parameter("attenuation"), Parameter("composite"), Parameter("draw", "splats"));
    GatherSettings gather;
    gather.projection = mode.value_or(IntensityProjection::None);
    gather.endTransmittance = culling.value_or(true) ? float(cullThreshold.value_or(double(gather.endTransmittance))) : 0.0f;
    frame.method = gather;
    return;
  }
  if (isProjected())
    fail(ErrorKind::Usage, "{} is drawn by marching rays: leave {}, {}, {} and {} out", Parameter("mode"), Parameter("draw", "splats"),
         Parameter("paper"), Parameter("attenuation"), Parameter("composite"));
  SplatSettings splats;
  splats.composite = composite.value_or(paper ? Composite::Additive : Composite::Normalised);
  splats.attenuation = attenuation.value_or(paper ? AttenuationLookup::Nearest : AttenuationLookup::Bilinear);
  splats.gradient = gradient.value_or(!paper);
  splats.culling = culling.value_or(!paper);
  splats.cullThreshold = float(cullThreshold.value_or(double(splats.cullThreshold)));
  frame.method = splats;
}

}  // namespace freevoxels
