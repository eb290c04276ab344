#include "engine/cube_drawing.h"

#include <algorithm>
#include <utility>

#include "engine/core/error.h"
#include "engine/cube_drawing_state.h"
#include "engine/gathering/gather_rows.h"
#include "engine/image/display_pass.h"
#include "engine/splatting/accumulate_pass.h"
#include "engine/splatting/splat_pass.h"

namespace freevoxels {

namespace {

/// Whether the coarser levels of a source are those of the octree: means of extinctions, of one colour. What a mean temperature emits is
/// not the mean emission.
bool hasOctree(const Volume& volume, const Classification& classification) {
  return !classification.transferFunction && !volume.albedo && !classification.emission;
}

FrameSettings exactSettings(const FrameSettings& wanted, bool octree) {
  FrameSettings settings = wanted;
  if (settings.lighting) settings.lighting->attenuation = LightAttenuation::Exact;
  if (!octree) settings.lod = 0.0f;
  return settings;
}

}  // namespace

/// The light of all lights together; null if there is none.
const ScatteringSolver* CubeDrawing::State::solveScattering(const FrameSettings& wanted, const Progress& progress) {
  if (!wanted.lighting || !hasScatteredLight(*wanted.lighting, brightestLight(classification, source->outline()) > 0.0)) return nullptr;
  if (!scattering) {
    const StageTimer timer(times, "scattering medium");
    const CubeLevel& base = levelAt(0);
    const Volume& outline = base.outline();
    ScatteringMedium medium(outline.dimensions, outline.indexToWorld);
    const std::span<const VoxelRange> cubes = base.cubes.pieces();
    for (std::size_t i = 0; i < cubes.size(); ++i) {
      if (progress) progress("reading cells", double(i) / double(cubes.size()));
      medium.add(base.read(cubes[i]), cubes[i].first, classification);
    }
    scattering.emplace(device, std::move(medium));
  }
  scattering->solve(*wanted.lighting, wanted.scatteringCoarseness, times, progress);
  return &*scattering;
}

/// The sums of no sample, in the form in which samples are added.
FixedSums CubeDrawing::State::emptySums(const Frame& frame, const FrameSettings& wanted) {
  const DeviceVolume& volume = levelAt(0).onDevice;
  FrameConstants constants = makeFrameConstants(device, volume, table, frame.camera, frame.settings);
  if (frame.scattered != nullptr) constants.scatteredRadiance = frame.scattered->brightest();
  FixedSums sums = sumsOfSamples(frame.lattice, classification.isPost(levelAt(0).outline()), sumsLayout(volume, constants, wanted));
  sums.method += ", cube by cube";
  return sums;
}

/// Emission, scattered light and distances are those of the first group.
CubeDrawing::State::LightGroups CubeDrawing::State::groupLights(const FrameSettings& wanted) const {
  constexpr std::size_t kAtOnce = shader::kMaxSampleLights;
  const Volume& outline = source->outline();
  LightGroups groups{.all = wanted.lighting ? wanted.lighting->lights : std::vector<Light>(),
                     .settings = {exactSettings(wanted, hasOctree(outline, classification))}};
  if (groups.all.size() <= kAtOnce) return groups;
  groups.settings.resize((groups.all.size() + kAtOnce - 1) / kAtOnce, groups.settings.front());
  for (std::size_t group = 0; group < groups.settings.size(); ++group) {
    Lighting& lighting = groups.settings[group].lighting.value();
    const auto begin = groups.all.begin() + std::ptrdiff_t(group * kAtOnce);
    lighting.lights.assign(begin, begin + std::ptrdiff_t(std::min(kAtOnce, groups.all.size() - group * kAtOnce)));
    if (group == 0) continue;
    groups.settings[group].depth = false;
    lighting.ambient = glm::dvec3(0.0);
    lighting.environment = nullptr;
  }
  return groups;
}

CubeDrawing::State::Frame CubeDrawing::State::frameOfGroup(const Camera& camera, const LightGroups& groups, std::size_t group,
                                                           const ScatteringSolver* scattered, const Progress& progress) {
  const FrameSettings& settings = groups.settings[group];
  Frame frame{.camera = camera,
              .settings = settings,
              .classification = group == 0 ? classification : dark,
              .allLights = groups.all,
              .firstLight = group * shader::kMaxSampleLights,
              .scattered = scattered,
              .progress = progress,
              .lattice = latticeOf(camera, settings)};
  frame.rows = {0, frame.lattice.samples.y};
  return frame;
}

void CubeDrawing::State::begin(const Camera& camera, const FrameSettings& wanted) {
  checkCamera(camera);
  checkFrameFits(device, wanted);
  times.clear();
  cubesRead.clear();
  dark = classification;
  dark.emission.reset();
  // Otherwise voxels without emission would be classified after interpolation.
  if (classification.emission) dark.order = ClassificationOrder::Pre;
}

std::optional<std::string> CubeDrawing::whyNot(const FrameSettings& settings) {
  if (!settings.gathers()) return "splats are drawn of the whole volume";
  if (settings.clip) return "rays are clipped in the whole volume";
  if (!settings.lighting) return {};
  if (lightAttenuationFor(settings) == LightAttenuation::Table) return "shadows from the table need the whole volume";
  return {};
}

CubeDrawing::CubeDrawing(const Device& device, std::shared_ptr<const VolumeSource> source, const Classification& classification,
                         const TableSettings& table)
    : state_(new State{.device = device, .source = std::move(source), .classification = classification, .table = table}) {}

CubeDrawing::~CubeDrawing() = default;

std::shared_ptr<const FrameTargets> CubeDrawing::draw(const Camera& camera, const FrameSettings& wanted, const Progress& progress) try {
  State& state = *state_;
  state.begin(camera, wanted);
  const ScatteringSolver* const scattered = state.solveScattering(wanted, progress);
  const State::LightGroups groups = state.groupLights(wanted);
  const auto drawGroup = [&](std::size_t group, const FrameTargets& targets) {
    State::Frame frame = state.frameOfGroup(camera, groups, group, scattered, progress);
    state.march(frame);
    state.resolve(frame, targets);
  };
  if (groups.settings.size() == 1) {
    std::shared_ptr<const FrameTargets> targets = state.targetPool.take(state.device, wanted, TargetKind::Image);
    drawGroup(0, *targets);
    return targets;
  }
  // Light adds up. Alpha does not depend on the lights.
  FrameTargets targets = makeTargets(state.device, wanted, TargetKind::Image);
  drawGroup(0, targets);
  Image image = downloadImage(state.device, targets);
  for (std::size_t group = 1; group < groups.settings.size(); ++group) {
    const FrameTargets more = makeTargets(state.device, groups.settings[group], TargetKind::Image);
    drawGroup(group, more);
    const std::vector<glm::vec4> pixels = downloadImage(state.device, more).pixels;
    for (std::size_t i = 0; i < pixels.size(); ++i) image.pixels[i] += glm::vec4(glm::vec3(pixels[i]), 0.0f);
  }
  targets.colorEnergy = uploadImage(state.device, image);
  return std::make_shared<const FrameTargets>(std::move(targets));
} catch (const Error& error) {
  if (error.kind() != ErrorKind::OutOfMemory) throw;
  throw state_->withNeed(error, camera, wanted);
}

FixedSums CubeDrawing::drawShares(const Camera& camera, const FrameSettings& wanted, const SharePart& part, const Progress& progress) try {
  State& state = *state_;
  state.begin(camera, wanted);
  const ScatteringSolver* const scattered = state.solveScattering(wanted, progress);
  const State::LightGroups groups = state.groupLights(wanted);
  FixedSums sums;
  for (std::size_t group = 0; group < groups.settings.size(); ++group) {
    State::Frame frame = state.frameOfGroup(camera, groups, group, scattered, progress);
    frame.rows = rowsOfPart(frame.lattice, part);
    if (group == 0) sums = state.emptySums(frame, wanted);
    if (frame.rows.x == frame.rows.y) continue;
    state.march(frame);
    const StageTimer timer(state.times, "copy to host");
    addSamples(sums, state.gather->downloadRows(frame.rows), frame.rows, group > 0);
  }
  return sums;
} catch (const Error& error) {
  if (error.kind() != ErrorKind::OutOfMemory) throw;
  throw state_->withNeed(error, camera, wanted);
}

const ScatteringSolver* CubeDrawing::scattered() const {
  return state_->scattering ? &*state_->scattering : nullptr;
}

const std::vector<StageTime>& CubeDrawing::timings() const {
  return state_->times;
}

const std::vector<std::size_t>& CubeDrawing::cubesRead() const {
  return state_->cubesRead;
}

}  // namespace freevoxels
