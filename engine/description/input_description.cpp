#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/machine.h"
#include "engine/description/scene_description.h"
#include "engine/description/text_values.h"
#include "engine/octree/volume_limits.h"
#include "engine/storage/baked_source.h"
#include "engine/storage/baked_volume.h"
#include "engine/volume/colors.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

namespace {

constexpr std::string_view kProceduralPrefix = "procedural:";

Volume openBaked(const std::shared_ptr<const fvx::FvxFile>& file, std::uint64_t maximumVoxels, int level,
                 const Progress& progress) {
  std::vector<std::string> warnings;
  Volume volume = readBaked(file, levelThatFits(*file, level, maximumVoxels, warnings), progress);
  volume.warnings = std::move(warnings);
  return volume;
}

std::string clipText(const VoxelBox& box) {
  return fmt::format("{},{},{},{},{},{}", box.first.x, box.first.y, box.first.z, box.last.x, box.last.y, box.last.z);
}

std::string clipText(const ClipPlane& plane) {
  return numberText(plane.point) + "," + numberText(plane.normal);
}

/// Fails unless the box has a voxel of a volume of this size.
void checkClipBox(const VoxelBox& box, glm::ivec3 size) {
  if (glm::any(glm::greaterThanEqual(box.first, size)))
    fail(ErrorKind::Usage, "{} has no voxel of the volume's box, which has {} x {} x {}", Parameter("clip-box", clipText(box)), size.x,
         size.y, size.z);
}

/// A part of a baked volume at its full resolution.
Volume openClippedBaked(const InputDescription& input, std::uint64_t maximumVoxels, const Progress& progress) {
  const auto file = std::make_shared<const fvx::FvxFile>(input.volume);
  if (!input.clipBox) return input.clip(openBaked(file, maximumVoxels, 0, progress));
  const glm::ivec3 size = file->dimensions(0);
  checkClipBox(*input.clipBox, size);
  const glm::u64vec3 extent(glm::min(input.clipBox->last, size - 1) - input.clipBox->first + 1);
  if (const std::uint64_t voxels = extent.x * extent.y * extent.z; voxels > maximumVoxels)
    fail(ErrorKind::OutOfMemory, "{} has {} voxels, and {} fit: give a smaller one", Parameter("clip-box", clipText(*input.clipBox)),
         voxels, maximumVoxels);
  Volume part = readBakedPart(file, *input.clipBox);
  part.isPart = true;
  return input.clip(std::move(part));
}

Volume readScanOf(const InputDescription& input, std::uint64_t maximumVoxels, const ReadRequest& what, const Progress& progress) {
  const auto refuse = [&](const char* name) {
    fail(ErrorKind::Usage, "{} is of OpenVDB files, and '{}' is a scan without such grids: leave it out", Parameter(name), input.volume);
  };
  if (what.more.temperature && what.more.temperature->isRequired) refuse("temperature-grid");
  const bool mustHaveColors = what.more.albedo && what.more.albedo->isRequired;
  ScanRequest request = input.scanRequest(maximumVoxels, progress);
  request.labels = what.labels.of(false);
  request.channels = what.channels;
  request.imageEdge = what.imageEdge;
  request.asColors = what.more.albedo.has_value();
  if (mustHaveColors && what.more.albedo->name != kColorsName) refuse("albedo-grid");
  Volume volume = readScan(input.volume, request);
  if (mustHaveColors && !(volume.albedo && volume.albedo->name == kColorsName)) refuse("albedo-grid");
  return volume;
}

}  // namespace

std::string resolutionText(glm::ivec3 dimensions) {
  const bool isCube = dimensions == glm::ivec3(dimensions.x);
  return isCube ? fmt::format("{}", dimensions.x) : fmt::format("{}x{}x{}", dimensions.x, dimensions.y, dimensions.z);
}

std::optional<std::string> proceduralName(const std::string& input) {
  if (!input.starts_with(kProceduralPrefix)) return std::nullopt;
  return input.substr(kProceduralPrefix.size());
}

int levelThatFits(const fvx::FvxFile& file, int level, std::uint64_t maximumVoxels, std::vector<std::string>& warnings) {
  const int fitting = finestLevel(file, maximumVoxels);
  if (fitting > level)
    warnings.push_back(fmt::format("{} is opened at 1/{} of its resolution: the {} voxels of its box are more than the {} that fit",
                                   file.path().string(), 1 << fitting, resolutionText(file.dimensions(0)), maximumVoxels));
  return std::max(fitting, level);
}

Volume openProcedural(const std::string& name, std::optional<glm::ivec3> resolution, std::uint64_t maximumVoxels,
                      const Progress& progress) {
  const glm::ivec3 dimensions = resolution.value_or(glm::ivec3(kDefaultResolution));
  const std::uint64_t needed = std::uint64_t(dimensions.x) * std::uint64_t(dimensions.y) * std::uint64_t(dimensions.z);
  const std::uint64_t available =
      std::min<std::uint64_t>(maximumVoxels, machineMemoryBytes() / sizeof(float));
  if (needed > available)
    fail(ErrorKind::OutOfMemory,
         "procedural:{} has {} voxels at {}, and {} fit: lower {}", name, needed,
         Parameter("resolution", resolutionText(dimensions)), available, Parameter("resolution"));
  Volume volume = makeProcedural(name, dimensions, progress);
  cropToActive(volume);
  return volume;
}

void InputDescription::checkGiven() const {
  if (volume.empty()) fail(ErrorKind::Usage, "IN is required: name an OpenVDB file, a scan, or procedural:NAME");
}

VolumeKind InputDescription::kind() const {
  if (proceduralName(volume)) return VolumeKind::Procedural;
  if (raw) return VolumeKind::Scan;
  if (fvx::isFvx(volume)) return VolumeKind::Baked;
  return isScanFile(volume) ? VolumeKind::Scan : VolumeKind::OpenVdb;
}

ScanRequest InputDescription::scanRequest(std::uint64_t maximumVoxels, const Progress& progress) const {
  return {.array = grid.value_or(""),
          .pyramidLevel = pyramidLevel,
          .memoryBytes = memoryBytes,
          .clipBox = clipBox,
          .raw = raw,
          .series = series,
          .timeStep = timeStep,
          .spacing = spacing,
          .noData = noData,
          .maximumVoxels = maximumVoxels,
          .progress = progress};
}

void InputDescription::check() const {
  const VolumeKind what = kind();
  const bool isProcedural = what == VolumeKind::Procedural, isBaked = what == VolumeKind::Baked;
  if (noData && isBaked)
    fail(ErrorKind::Usage, "{} does not apply to a baked volume such as '{}': give it to 'freevoxels bake'", Parameter("no-data"), volume);
  if (grid && isBaked)
    fail(ErrorKind::Usage, "{} chooses among the grids of an OpenVDB file, and '{}' is a baked volume", Parameter("grid"), volume);
  if (clipBox && glm::any(glm::greaterThan(clipBox->first, clipBox->last)))
    fail(ErrorKind::Usage, "{} is empty: give the smaller coordinates first", Parameter("clip-box", clipText(*clipBox)));
  if (clipPlane && glm::length(clipPlane->normal) < 1e-30)
    fail(ErrorKind::Usage, "{} has a normal of length 0: give one such as 1,0,0", Parameter("clip-plane", clipText(*clipPlane)));
  if (grid && isProcedural) fail(ErrorKind::Usage, "{} chooses among the grids of a file, and {} has one", Parameter("grid"), volume);
  if (resolution && !isProcedural)
    fail(ErrorKind::Usage, "{} is for procedural:NAME, and '{}' has the resolution of its grid", Parameter("resolution"), volume);
  for (const auto& [isGiven, name] :
       {std::pair(raw.has_value(), "raw"), std::pair(series.has_value(), "series"), std::pair(timeStep.has_value(), "time-step"),
        std::pair(spacing.has_value(), "spacing"), std::pair(pyramidLevel.has_value(), "pyramid-level")})
    if (isGiven && what != VolumeKind::Scan) fail(ErrorKind::Usage, "{} is for scans, and '{}' is none", Parameter(name), volume);
  if (spacing && !(std::min({spacing->x, spacing->y, spacing->z}) > 0.0))
    fail(ErrorKind::Usage, "{} must be above 0 along all axes", Parameter("spacing", numberText(*spacing)));
}

std::shared_ptr<const fvx::FvxFile> InputDescription::baked() const {
  if (isClipped() || kind() != VolumeKind::Baked) return nullptr;
  return std::make_shared<const fvx::FvxFile>(volume);
}

Volume InputDescription::open(std::uint64_t maximumVoxels, const ReadRequest& what, int level, const Progress& progress) const {
  const VolumeKind kindOfVolume = kind();
  if (const auto file = baked()) return openBaked(file, maximumVoxels, level, progress);
  if (kindOfVolume == VolumeKind::Baked) return openClippedBaked(*this, maximumVoxels, progress);
  if (kindOfVolume == VolumeKind::Scan) return clip(readScanOf(*this, maximumVoxels, what, progress));
  if (kindOfVolume == VolumeKind::OpenVdb) {
    ReadRequest request = what;
    request.grid = grid.value_or("");
    request.maximumVoxels = maximumVoxels;
    request.clipBox = clipBox;
    request.noData = noData;
    request.progress = progress;
    return clip(readVdb(volume, request));
  }
  Volume made = openProcedural(*proceduralName(volume), resolution, maximumVoxels, progress);
  if (!what.more.temperature) made.temperature.reset();
  if (noData) summariseValues(made, noData->scalar());
  settleNoData(made, noData);
  if (what.labels.of(false)) showLabels(made, *what.labels.of(false));
  if (made.activeVoxels == 0 && !made.temperature)
    fail(ErrorKind::Usage, "all voxels of {} have the value of {}: leave it out", volume, Parameter("no-data"));
  return clip(std::move(made));
}

void InputDescription::fixLevel(int imageEdge) {
  if (pyramidLevel || kind() != VolumeKind::Scan) return;
  try {
    ScanRequest request = scanRequest(kMaxNumberedVoxels);
    request.imageEdge = imageEdge;
    const ScanHeader header = readScanHeader(volume, request);
    if (header.levels.size() < 2) return;
    pyramidLevel = header.level;
    if (header.part) clipBox = header.part;
  } catch (const Error&) {
    // Whoever opens it fails with the same sentence.
  }
}

Volume InputDescription::clip(Volume whole) const {
  if (clipBox && !whole.isPart) {
    checkClipBox(*clipBox, whole.dimensions);
    whole = clippedVolume(whole, *clipBox);
  }
  if (!clipPlane) return whole;
  const bool hadVoxels = whole.activeVoxels > 0;
  whole = clippedVolume(whole, *clipPlane);
  if (hadVoxels && whole.activeVoxels == 0)
    fail(ErrorKind::Usage, "{} has no voxel behind it: move it, or turn its normal round", Parameter("clip-plane", clipText(*clipPlane)));
  return whole;
}

RayClip InputDescription::rayClip(const Volume& whole) const {
  RayClip clip{.low = glm::dvec3(-0.5), .high = glm::dvec3(whole.dimensions) - 0.5};
  if (clipBox && !whole.isPart) {
    clip.low = glm::max(clip.low, glm::dvec3(clipBox->first) - 0.5);
    clip.high = glm::min(clip.high, glm::dvec3(clipBox->last) + 0.5);
  }
  if (clipPlane) {
    const glm::dvec3 normal = glm::transpose(glm::dmat3(whole.indexToWorld)) * glm::normalize(clipPlane->normal);
    const double length = glm::length(normal);
    clip.normal = normal / length;
    clip.distance = glm::dot(glm::normalize(clipPlane->normal), clipPlane->point - glm::dvec3(whole.indexToWorld[3])) / length;
  }
  return clip;
}

std::vector<std::string> warningsOf(const Volume& volume, bool scalarsAreDensities) {
  std::vector<std::string> warnings = volume.warnings;
  const auto warn = [&](std::uint64_t voxels, const char* what) {
    if (voxels == 0) return;
    const bool one = voxels == 1;
    warnings.push_back(fmt::format("{} voxel{} of {} with {} count{} as 0", voxels, one ? "" : "s", volume.source, what, one ? "s" : ""));
  };
  const auto count = [](std::uint64_t voxels) { return fmt::format("{} voxel{}", voxels, voxels == 1 ? "" : "s"); };
  if (volume.nanVoxels > 0)
    warnings.push_back(fmt::format("{} of {} whose value is NaN or infinite hold{} no data", count(volume.nanVoxels), volume.source,
                                   volume.nanVoxels == 1 ? "s" : ""));
  if (volume.overflownVoxels > 0)
    warnings.push_back(
        fmt::format("{} of {} had too large a value for the 16-bit floats of the file: they have the largest of those, 65504",
                    count(volume.overflownVoxels), volume.source));
  const auto warnOfOutliers = [&](const auto& values, const char* what) {
    if (values.outlierVoxels > 0)
      warnings.push_back(
          fmt::format("{}{} of {} {} beyond all others by a factor of a thousand and more, up to {:g}: {} drawn like the "
                      "largest of the others, {:g}",
                      what, count(values.outlierVoxels), volume.source, values.outlierVoxels == 1 ? "is" : "are", values.farthestOutlier,
                      values.outlierVoxels == 1 ? "it is" : "they are", std::max(values.maximum, -values.minimum)));
  };
  warnOfOutliers(volume, "");
  if (volume.temperature) warnOfOutliers(*volume.temperature, "the temperatures of ");
  if (volume.albedo && volume.albedo->clippedVoxels > 0)
    warnings.push_back(fmt::format("{} voxels of grid '{}' have components outside of 0..1, which are clipped to it",
                                   volume.albedo->clippedVoxels, volume.albedo->name));
  if (scalarsAreDensities) warn(volume.negativeVoxels, "negative density");
  return warnings;
}

std::string remarksOf(const Volume& volume) {
  return volume.remarks.empty() ? "" : fmt::format("{}: {}", volume.source, fmt::join(volume.remarks, "; "));
}

}  // namespace freevoxels
