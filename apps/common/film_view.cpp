#include "apps/common/film_view.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/storage/baked_volume.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

/// What the header of a frame's file tells of it.
struct Outline {
  std::string input;
  std::vector<glm::dvec3> corners;      ///< of its box, in the world
  std::optional<std::uint64_t> voxels;  ///< unknown where the file has to be read
};

Outline outlineOf(const SceneDescription& description, const std::string& input) {
  const SceneDescription scene = description.of(input);
  Outline outline{.input = input, .corners = {}, .voxels = std::nullopt};
  if (const auto file = scene.input.baked()) {
    const Volume volume = bakedOutline(*file);
    outline.corners = boxOf(volume).points;
    outline.voxels = volume.activeVoxels;
  } else if (const VolumeKind kind = scene.input.kind(); kind == VolumeKind::Scan) {
    const ScanHeader header = readScanHeader(input, scene.input.scanRequest(0));
    outline.voxels = header.samples();
    if (!scene.input.isClipped())
      outline.corners = boxOf(Volume{.dimensions = header.dimensions, .indexToWorld = header.indexToWorld}).points;
  } else if (kind == VolumeKind::OpenVdb && scene.classification.channels.empty()) {
    const auto extent = extentOfVdb(input, scene.input.grid.value_or(""),
                                    {.temperature = scene.emission.grid(), .albedo = std::nullopt, .mayBeMissing = true});
    if (!extent) return outline;
    outline.voxels = extent->voxels;
    if (!scene.input.clipBox && !scene.input.clipPlane) outline.corners = extent->corners;
  }
  return outline;
}

/// Runs `work`; false if the frame is empty or cannot be read, which is said when it is drawn.
template <typename Work>
bool attempt(const Work& work) {
  try {
    work();
    return true;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::Input && error.kind() != ErrorKind::OutOfMemory && error.kind() != ErrorKind::Usage) throw;
    return false;
  }
}

/// The frames to read.
std::vector<std::size_t> choose(const std::vector<Outline>& frames) {
  std::vector<std::size_t> full;
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (frames[i].voxels != 0u) full.push_back(i);
  if (full.empty()) return full;
  std::set<std::size_t> chosen{*std::ranges::max_element(full, {}, [&](std::size_t i) { return frames[i].voxels.value_or(0); })};
  const std::size_t most = std::min(full.size(), kMaxFramesRead);
  for (std::size_t i = 0; i < most && chosen.size() < most; ++i) chosen.insert(full[most == 1 ? 0 : i * (full.size() - 1) / (most - 1)]);
  return {chosen.begin(), chosen.end()};
}

/// The integral of the density over the volume.
double massOf(const Volume& volume) {
  if (!(volume.maximum > 0.0f)) return 0.0;
  const double edge = std::cbrt(double(volume.activeVoxels)) * volume.voxelSize();
  return edge * edge / automaticDensityScale(volume, 1.0);
}

/// The integral of the fourth power of the temperatures, as black bodies radiate, whatever their unit.
double powerOf(const Volume& volume) {
  double power = 0.0;
  for (std::size_t number = 0; number < volume.temperature->values.count(); ++number)
    for (const float value : volume.temperature->values.brick(number)) power += std::pow(std::max(double(value), 0.0), 4.0);
  return power * std::pow(volume.voxelSize(), 3.0);
}

/// Fails if no file has the grid of the densities that is named, as single frames may lack it.
void refuseMissingDensity(const std::string& name, std::span<const std::string> inputs) {
  const auto mayHave = [&](const std::string& input) {
    bool has = false;
    const bool isRead = attempt([&] { has = InputDescription{.volume = input}.kind() != VolumeKind::OpenVdb || hasGrid(input, name); });
    return has || !isRead;
  };
  if (std::ranges::none_of(inputs, mayHave))
    fail(ErrorKind::Input, "no frame has a grid '{}': choose another with {}", name, Parameter("grid"));
}

class Survey {
 public:
  explicit Survey(const SceneDescription& description) : description_(description) {}

  void add(const std::string& input, std::shared_ptr<Volume> volume) {
    const bool burns = volume->temperature && !description_.method.showsValues() && description_.emission.mayShine(*volume->temperature);
    const double mass = massOf(*volume), power = burns ? powerOf(*volume) : 0.0;
    SceneDescription own = description_;
    if (!volume->temperature && !volume->classification) own.emission = {.emission = false};
    const Subject content = contentOf(*volume, own.resolveClassification(*volume));
    contents_.points.insert(contents_.points.end(), content.points.begin(), content.points.end());
    contents_.margin = content.margin;
    if (burns) {
      hottest_.activeVoxels += volume->temperature->activeVoxels;
      hottest_.minimum = std::min(hottest_.minimum, volume->temperature->minimum);
      hottest_.maximum = std::max(hottest_.maximum, volume->temperature->maximum);
    }
    hasAlbedo_ = hasAlbedo_ || volume->albedo;
    if (power > brightest_.amount) brightest_ = {power, input, volume};
    if (!largest_.volume || mass > largest_.amount) largest_ = {mass, input, volume};
  }
  bool isEmpty() const { return !largest_.volume; }

  /// `corners` are those of the boxes of frames that were not added.
  FilmView resolve(const std::vector<glm::dvec3>& corners) {
    const Volume& volume = *largest_.volume;
    refuseMissingChannels(volume);
    FilmView view{.scene = {.volume = largest_.volume}, .largest = largest_.input, .brightest = ""};
    Classification& classification = view.scene.classification;
    const std::optional<Emission> emission = volume.classification ? std::nullopt : emissionScales();
    classification = volume.classification || description_.method.showsValues()
                         ? description_.resolveClassification(volume)
                         : description_.classification.resolve(volume, emission.has_value());
    if (emission) {
      view.brightest = brightest_.input;
      classification.emission = emission;
      if (!description_.emission.strength)
        classification.emission->strength = automaticEmissionStrength(*brightest_.volume, classification, *emission);
      if (!description_.classification.albedo) classification.albedo = glm::vec3(kSmokeAlbedo);
    }
    view.scene.camera = description_.method.slice ? sliceCameraOf(description_, volume)
                                                  : description_.camera
                                                        .resolve(
                                                            volume, [&] { return subjectOf(corners); }, 1)
                                                        .front();
    view.scene.lighting = description_.resolveLighting(volume, classification, view.scene.camera);
    forgetVoxels();
    return view;
  }

 private:
  struct Most {
    double amount = 0.0;
    std::string input;
    std::shared_ptr<Volume> volume;
  };

  /// Fails where no frame has a grid that is asked for, as the single frames may lack it.
  void refuseMissingChannels(const Volume& volume) const {
    if (volume.classification) return;
    if (description_.emission.isAsked() && hottest_.activeVoxels == 0)
      fail(ErrorKind::Input, "no frame that was looked at has temperatures: leave {} out",
           Parameter(description_.emission.temperatureGrid ? "temperature-grid" : "emission"));
    const std::optional<GridRequest> albedo = description_.classification.grid();
    if (albedo && albedo->isRequired && !hasAlbedo_)
      fail(ErrorKind::Input, "no frame that was looked at has a grid '{}': choose another with {}", albedo->name, Parameter("albedo-grid"));
  }

  /// Nothing where the film does not shine.
  std::optional<Emission> emissionScales() const {
    const EmissionDescription& given = description_.emission;
    if (!brightest_.volume || given.emission == false) return std::nullopt;
    const Emission scales = given.scales(hottest_);
    if (!given.isAsked() && !(brightestLight(scales, hottest_, hottest_.maximum) > 0.0)) return std::nullopt;
    return scales;
  }

  /// What is seen of the frames that were read, and the boxes of the others as far as these may go on from there: a box may be much
  /// larger than what is in it, with a single voxel at its end, or air all around.
  Subject subjectOf(const std::vector<glm::dvec3>& corners) const {
    constexpr double kGrowth = 0.2;  // of the extent, on each side
    std::vector<glm::dvec3> points = contents_.points;
    glm::dvec3 low = points.front(), high = low;
    const auto include = [&](const glm::dvec3& point) {
      low = glm::min(low, point);
      high = glm::max(high, point);
    };
    std::ranges::for_each(points, include);
    const glm::dvec3 reach = kGrowth * (high - low), lowest = low - reach, highest = high + reach;
    for (const glm::dvec3& corner : corners) points.push_back(glm::clamp(corner, lowest, highest));
    std::ranges::for_each(points, include);
    return {.centre = (low + high) / 2.0, .points = std::move(points), .margin = contents_.margin};
  }

  /// What is said of a frame is said when it is drawn.
  void forgetVoxels() {
    Volume& volume = *largest_.volume;
    if (brightest_.volume) {
      hottest_.name = brightest_.volume->temperature->name;
      volume.temperature = hottest_;
    }
    forEachGrid([&](ScalarBricks& values) { values = ScalarBricks(volume.dimensions); }, volume);
    volume.warnings.clear();
    volume.nanVoxels = volume.negativeVoxels = volume.overflownVoxels = volume.outlierVoxels = 0;
  }

  const SceneDescription description_;
  Subject contents_;          ///< what is seen of the frames
  Most largest_, brightest_;  ///< with most mass, and with most power
  TemperatureGrid hottest_;   ///< the range of all frames
  bool hasAlbedo_ = false;
};

}  // namespace

std::optional<FilmView> viewOfFilm(const SceneDescription& description, std::span<const std::string> inputs, std::uint64_t maximumVoxels,
                                   const Progress& progress) {
  if (description.input.grid) refuseMissingDensity(*description.input.grid, inputs);
  std::vector<Outline> frames;
  for (const std::string& input : inputs) attempt([&] { frames.push_back(outlineOf(description, input)); });
  Survey survey(description.of(inputs.front()));
  for (const std::size_t i : choose(frames)) {
    const bool isRead = attempt([&] {
      const SceneDescription scene = description.of(frames[i].input);
      const auto baked = scene.input.baked();
      survey.add(frames[i].input, std::make_shared<Volume>(baked ? bakedOutline(*baked) : scene.readVolume(maximumVoxels, 0, progress, true)));
    });
    if (isRead) frames[i].corners.clear();
  }
  if (survey.isEmpty()) return std::nullopt;
  std::vector<glm::dvec3> corners;
  for (const Outline& frame : frames) corners.insert(corners.end(), frame.corners.begin(), frame.corners.end());
  return survey.resolve(corners);
}

}  // namespace freevoxels
