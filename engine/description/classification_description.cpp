#include <algorithm>

#include "engine/core/error.h"
#include "engine/description/scene_description.h"
#include "engine/description/text_values.h"
#include "engine/volume/scan.h"

namespace freevoxels {

namespace {

/// Too little for a display to show.
constexpr float kInvisibleOpacity = 1e-6f;

/// Changes a function so that values in which nothing is seen count in a mean: transparent voxels are not stored, and a function's table
/// resolves values only near its points.
void keepAllValues(TransferFunction& function, const Volume& volume) {
  std::vector<TransferFunction::OpacityPoint>& points = function.opacity;
  if (volume.minimum < points.front().scalar) points.insert(points.begin(), {volume.minimum, points.front().opacity});
  if (volume.maximum > points.back().scalar) points.push_back({volume.maximum, points.back().opacity});
  for (TransferFunction::OpacityPoint& point : points) point.opacity = std::max(point.opacity, kInvisibleOpacity);
}

/// What a baked volume was baked with, changed by what is given.
Classification bakedClassification(const ClassificationDescription& given, const Volume& volume) {
  if (given.albedoGrid && given.albedoGrid != kNone)
    fail(ErrorKind::Usage, "{} chooses among the grids of an OpenVDB file, and {} is a baked volume: give it to 'freevoxels bake'",
         Parameter("albedo-grid"), volume.source);
  Classification classification = *volume.classification;
  const bool isChanged = given.densityScale || given.albedo || given.transferFunction || given.iso || given.order;
  if (isChanged && volume.classificationIsFixed)
    fail(ErrorKind::Usage,
         "{} was baked for one classification, which {}, {}, {} and {} cannot change: leave them out, or bake it with {}",
         volume.source, Parameter("density-scale"), Parameter("albedo"), Parameter("transfer-function"), Parameter("classification"),
         Parameter("keep-scalars"));
  if (given.densityScale || given.albedo) classification.transferFunction.reset();
  if (given.densityScale) classification.densityScale = *given.densityScale;
  if (given.albedo) classification.albedo = glm::vec3(*given.albedo);
  if (given.order) classification.order = *given.order;
  return classification;
}

}  // namespace

Classification ClassificationDescription::resolve(const Volume& volume, bool shines) const {
  Classification classification;
  if (((labels && !labels->isNone()) || !channels.empty()) && !(volume.albedo && volume.albedo->isMade))
    fail(ErrorKind::Usage, "{} says how the values of a volume are read, and {} has been read without: give it where that is opened",
         Parameter(channels.empty() ? "labels" : "channel"), volume.source);
  if (volume.classification) classification = bakedClassification(*this, volume);
  if ((transferFunction || iso) && channels.empty() && volume.albedo && volume.albedo->isMade)
    fail(ErrorKind::Usage, "{} is of one grid of values, and {} is drawn with several channels: choose one with {}",
         Parameter(iso ? "iso" : "transfer-function"), volume.source, Parameter("grid", "NAME"));
  if (iso) {
    classification.transferFunction = isoFunction(*iso, volume);
    classification.order = order.value_or(ClassificationOrder::Post);
    return classification;
  }
  if (transferFunction) {
    classification.transferFunction = isInlineJson(*transferFunction)
                                          ? parseTransferFunction(*transferFunction, volume)
                                          : readTransferFunction(*transferFunction, volume);
    classification.order = order.value_or(ClassificationOrder::Post);
    return classification;
  }
  if (volume.classification) return classification;
  if (!densityScale && !albedo && !volume.albedo && !shines && looksLikeScan(volume)) {
    classification.transferFunction = scanTransferFunction(volume);
    classification.order = order.value_or(ClassificationOrder::Post);
    return classification;
  }
  if (densityScale)
    classification.densityScale = *densityScale;
  else if (volume.isSolid)
    classification.densityScale = kSolidOpticalDepth / volume.voxelSize();
  else
    classification.densityScale = automaticDensityScale(volume, shines ? kShiningOpticalDepth : kAutomaticOpticalDepth);
  if (albedo) classification.albedo = glm::vec3(*albedo);
  return classification;
}

Classification ClassificationDescription::resolveProjected(const Volume& volume, IntensityProjection projection) const {
  for (const auto& [name, isGiven] : {std::pair("iso", iso.has_value()), {"labels", labels.has_value()}, {"channel", !channels.empty()}})
    if (isGiven)
      fail(ErrorKind::Usage, "{} shows values by a transfer function, and {} has no part in that: leave it out", Parameter("mode"),
           Parameter(name));
  if (volume.classificationIsFixed)
    fail(ErrorKind::Usage, "{} shows values, and {} was baked for one classification without them: bake it with {}", Parameter("mode"),
         volume.source, Parameter("keep-scalars"));
  Classification classification;
  if (transferFunction)
    classification.transferFunction =
        ClassificationDescription{.transferFunction = transferFunction}.resolve(volume, false).transferFunction;
  else if (volume.classification)
    classification.transferFunction = volume.classification->transferFunction;
  if (!classification.transferFunction) classification.transferFunction = intensityFunction(volume, projection);
  if (projection == IntensityProjection::Average) keepAllValues(*classification.transferFunction, volume);
  return classification;
}

std::optional<GridRequest> ClassificationDescription::grid() const {
  if (albedoGrid) return *albedoGrid == kNone ? std::nullopt : std::optional(GridRequest{.name = *albedoGrid, .isRequired = true});
  return albedo || transferFunction || iso || !channels.empty() ? std::nullopt : std::optional(GridRequest());
}

void ClassificationDescription::check(const InputDescription& input) const {
  const VolumeKind kind = input.volume.empty() ? VolumeKind::OpenVdb : input.kind();
  for (const auto& [name, isGiven] : {std::pair("labels", labels.has_value()), {"channel", !channels.empty()}})
    if (isGiven && kind == VolumeKind::Baked)
      fail(ErrorKind::Usage, "{} says how values are read, and '{}' is a baked volume: give it to 'freevoxels bake'", Parameter(name),
           input.volume);
  if (channels.empty()) return;
  doEmit(channels);
  if (kind != VolumeKind::OpenVdb && kind != VolumeKind::Scan)
    fail(ErrorKind::Usage, "{} names grids of an OpenVDB file or channels of a scan, and '{}' has one", Parameter("channel"), input.volume);
  if (input.grid) fail(ErrorKind::Usage, "{} and {} exclude each other: channels are grids", Parameter("channel"), Parameter("grid"));
}

LabelRequest ClassificationDescription::labelRequest() const {
  if (labels) return {.labels = *labels, .ofAllGrids = true};
  if (densityScale || albedo || transferFunction || iso || albedoGrid) return {};
  return {.labels = Labels()};
}

void ClassificationDescription::take(const Classification& resolved) {
  if (!resolved.transferFunction) {
    densityScale = resolved.densityScale;
    albedo = glm::dvec3(resolved.albedo);
    return;
  }
  transferFunction = transferFunctionJson(*resolved.transferFunction);  // with its range, which a file may leave to the volume
  order = resolved.order;
}

}  // namespace freevoxels
