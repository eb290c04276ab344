#include "engine/volume/volume_of_scalars.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/error.h"
#include "engine/volume/colors.h"

namespace freevoxels {

namespace {

void checkTransform(const glm::dmat4& indexToWorld, const std::string& source) {
  const double determinant = glm::determinant(glm::dmat3(indexToWorld));
  const glm::dvec4 origin = indexToWorld[3];
  if (!std::isfinite(determinant) || !(std::abs(determinant) > 0.0) || !std::isfinite(origin.x + origin.y + origin.z))
    fail(ErrorKind::Input,
         "voxels of {} have no extent: spacing, origin and transform must be finite, and the spacing along each axis not 0", source);
}

}  // namespace

Volume volumeOfChannels(std::vector<ScalarBricks> values, const glm::dmat4& indexToWorld, const std::vector<ChannelStyle>& channels,
                        const std::string& source) {
  checkTransform(indexToWorld, source);
  Volume volume{.source = source, .dimensions = values.front().dimensions(), .indexToWorld = indexToWorld};
  normaliseWorld(volume);
  mixChannels(volume, channels, std::move(values));
  if (volume.activeVoxels == 0 && !(volume.temperature && volume.temperature->activeVoxels > 0))
    fail(ErrorKind::Input, "the channels of {} hold nothing above the beginning of their windows: give them other windows", source);
  return volume;
}

Volume volumeOfColors(std::vector<ScalarBricks> components, SampleType type, const glm::dmat4& indexToWorld, const std::string& source) {
  checkTransform(indexToWorld, source);
  Volume volume{.source = source, .dimensions = components.front().dimensions(), .indexToWorld = indexToWorld};
  normaliseWorld(volume);
  showColors(volume, std::move(components), type);
  if (volume.activeVoxels == 0) fail(ErrorKind::Input, "all voxels of {} are black or transparent, so that nothing is to be seen", source);
  return volume;
}

glm::dmat4 latticeTransform(const glm::dvec3& spacing, const glm::dvec3& origin) {
  return glm::scale(glm::translate(glm::dmat4(1.0), origin), spacing);
}

Volume volumeOfScalars(ScalarBricks scalars, const glm::dmat4& indexToWorld, const std::optional<NoData>& noData, const std::string& source,
                       const Labels* labels) {
  checkTransform(indexToWorld, source);
  Volume volume{.source = source, .dimensions = scalars.dimensions(), .indexToWorld = indexToWorld, .scalars = std::move(scalars)};
  normaliseWorld(volume);
  if (labels != nullptr)
    showLabels(volume, *labels);
  else
    summariseValues(volume, noData ? noData->scalar() : std::nullopt);
  const glm::ivec3 size = volume.dimensions;
  if (volume.activeVoxels == 0)
    fail(ErrorKind::Input, "{} of {} x {} x {} voxels holds no data: {}", source, size.x, size.y, size.z,
         labels != nullptr ? kNoLabelClause : "all its values are NaN, or mark that there is none");
  if (labels != nullptr) return volume;
  volume.isFog = looksLikeFog(volume);
  if (volume.isFog) {
    summariseValues(volume, 0.0f);
    volume.remarks.push_back(
        fmt::format("its values are taken for densities, and 0 for no data ({} draws it as a scan)", Parameter("transfer-function")));
  } else {
    settleNoData(volume, noData);
  }
  orientScan(volume);
  return volume;
}

}  // namespace freevoxels
