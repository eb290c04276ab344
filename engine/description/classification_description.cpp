#include <algorithm>

#include "engine/core/error.h"
#include "engine/description/scene_description.h"
#include "engine/description/text_values.h"
#include "engine/volume/scan.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

/// Too little for a display to show.
constexpr float kInvisibleOpacity = 1e-6f;

/// Makes the largest opacity 1: those of most functions are of a length, and a projection shows a single value.
void makeOpaque(TransferFunction& function) {
  const float most = std::ranges::max(function.opacity, {}, &TransferFunction::OpacityPoint::opacity).opacity;
  if (most == 0.0f) return;
  for (TransferFunction::OpacityPoint& point : function.opacity) point.opacity /= most;
}

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
  const bool isChanged = given.densityScale || given.albedo || given.transferFunction || given.iso || given.order ||
                         given.change() != TransferChange{};
  if (isChanged && volume.classificationIsFixed)
    fail(ErrorKind::Usage,
         "{} was baked for one classification, which {}, {}, {}, {}, {}, {} and {} cannot change: leave them out, or bake it with {}",
         volume.source, Parameter("density-scale"), Parameter("albedo"), Parameter("transfer-function"), Parameter("window"),
         Parameter("opacity"), Parameter("invert"), Parameter("classification"), Parameter("keep-scalars"));
  if (given.densityScale || given.albedo) classification.transferFunction.reset();
  if (given.densityScale) classification.densityScale = *given.densityScale;
  if (given.albedo) classification.albedo = glm::vec3(*given.albedo);
  if (given.order) classification.order = *given.order;
  return classification;
}

/// The transfer function to draw with; nothing for densities. `baked` is that of a baked volume.
std::optional<TransferFunction> functionToDraw(const ClassificationDescription& given, const Classification& baked, const Volume& volume,
                                               bool shines) {
  if (given.iso) return isoFunction(*given.iso, volume);
  if (given.transferFunction) return fitted(readTransferCurves(*given.transferFunction), volume, given.change());
  if (volume.classification && baked.transferFunction) return changed(*baked.transferFunction, given.change());
  if (given.window) return fitted(curvesOf(*presetNamed(kFunctionOfWindow)), volume, given.change());
  const bool isAutomatic = !given.densityScale && !given.albedo && !volume.albedo && !shines && !volume.classification;
  if (isAutomatic && looksLikeScan(volume)) return changed(scanTransferFunction(volume), given.change());
  return std::nullopt;
}

/// Fails for labels and channels of a volume that was read without, and for a transfer function of one that was read with channels.
void checkMade(const ClassificationDescription& given, const Volume& volume) {
  const bool isMade = volume.madeOf != MadeOf::Grids;
  if (((given.labels && !given.labels->isNone()) || !given.channels.empty()) && !isMade)
    fail(ErrorKind::Usage, "{} says how the values of a volume are read, and {} has been read without: give it where that is opened",
         Parameter(given.channels.empty() ? "labels" : "channel"), volume.source);
  if ((given.transferFunction || given.iso) && given.channels.empty() && isMade)
    fail(ErrorKind::Usage, "{} is of one grid of values, and {} is drawn with several channels: choose one with {}",
         Parameter(given.iso ? "iso" : "transfer-function"), volume.source, Parameter("grid", "NAME"));
}

}  // namespace

Classification ClassificationDescription::resolve(const Volume& volume, bool shines) const {
  Classification classification;
  if (volume.classification) classification = bakedClassification(*this, volume);
  checkMade(*this, volume);
  if (auto function = functionToDraw(*this, classification, volume, shines)) {
    const bool isBaked = !transferFunction && !iso && classification.transferFunction;
    if (!isBaked) classification.order = order.value_or(ClassificationOrder::Post);
    classification.transferFunction = std::move(function);
    return classification;
  }
  if (invert)
    fail(ErrorKind::Usage, "{} turns the colours of a transfer function round, and {} is drawn without: give {}", Parameter("invert"),
         volume.source, Parameter("transfer-function"));
  if (!volume.classification) {
    if (densityScale)
      classification.densityScale = *densityScale;
    else if (volume.isSolid)
      classification.densityScale = kSolidOpticalDepth / volume.voxelSize();
    else
      classification.densityScale = automaticDensityScale(volume, shines ? kShiningOpticalDepth : kAutomaticOpticalDepth);
    if (albedo) classification.albedo = glm::vec3(*albedo);
  }
  classification.densityScale *= opacity.value_or(1.0);
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
    classification.transferFunction = fitted(readTransferCurves(*transferFunction), volume, change());
  else if (volume.classification && volume.classification->transferFunction)
    classification.transferFunction = changed(*volume.classification->transferFunction, change());
  else
    classification.transferFunction = changed(intensityFunction(volume, projection), change());
  makeOpaque(*classification.transferFunction);
  if (projection == IntensityProjection::Average) keepAllValues(*classification.transferFunction, volume);
  return classification;
}

Classification ClassificationDescription::resolveSliced(const Volume& volume) const {
  Classification classification;
  checkMade(*this, volume);
  if (volume.madeOf != MadeOf::Grids) return classification;
  if (volume.classificationIsFixed)
    fail(ErrorKind::Usage, "{} shows values, and {} was baked for one classification without them: bake it with {}", Parameter("slice"),
         volume.source, Parameter("keep-scalars"));
  if (!transferFunction && volume.classification && volume.classification->transferFunction)
    classification.transferFunction = changed(*volume.classification->transferFunction, change());
  else
    classification.transferFunction = fitted(readTransferCurves(transferFunction.value_or(kFunctionOfWindow)), volume, change());
  return classification;
}

std::optional<GridRequest> ClassificationDescription::grid() const {
  if (albedoGrid) return *albedoGrid == kNone ? std::nullopt : std::optional(GridRequest{.name = *albedoGrid, .isRequired = true});
  return albedo || transferFunction || iso || window || invert || !channels.empty() ? std::nullopt : std::optional(GridRequest());
}

void ClassificationDescription::check(const InputDescription& input) const {
  const VolumeKind kind = input.volume.empty() ? VolumeKind::OpenVdb : input.kind();
  for (const auto& [name, isGiven] : {std::pair("labels", labels.has_value()), {"channel", !channels.empty()}})
    if (isGiven && kind == VolumeKind::Baked)
      fail(ErrorKind::Usage, "{} says how values are read, and '{}' is a baked volume: give it to 'freevoxels bake'", Parameter(name),
           input.volume);
  if (channels.empty()) return;
  checkCount(channels);
  if (kind != VolumeKind::OpenVdb && kind != VolumeKind::Scan)
    fail(ErrorKind::Usage, "{} names grids of an OpenVDB file or channels of a scan, and '{}' has one", Parameter("channel"), input.volume);
  if (input.grid) fail(ErrorKind::Usage, "{} and {} exclude each other: channels are grids", Parameter("channel"), Parameter("grid"));
}

LabelRequest ClassificationDescription::labelRequest() const {
  if (labels) return {.labels = *labels, .ofAllGrids = true};
  if (densityScale || albedo || transferFunction || iso || albedoGrid || window || invert) return {};
  return {.labels = Labels()};
}

void ClassificationDescription::take(const Classification& resolved) {
  if (!resolved.transferFunction) {
    takeDensityScale(resolved.densityScale);
    albedo = glm::dvec3(resolved.albedo);
    return;
  }
  takeFunction(*resolved.transferFunction);
  order = resolved.order;
}

void ClassificationDescription::takeFunction(const TransferFunction& resolved) {
  transferFunction = transferFunctionJson(resolved);  // with its range, which a file may leave to the volume
  window.reset();
  opacity.reset();
  invert = false;
}

void ClassificationDescription::takeDensityScale(double resolved) {
  densityScale = resolved;
  opacity.reset();
}

}  // namespace freevoxels
