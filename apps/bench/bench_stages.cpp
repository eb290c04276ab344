#include "apps/bench/bench_stages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "engine/attenuation/table_levels.h"
#include "engine/octree/volume_builder.h"
#include "engine/memory_planner.h"
#include "engine/renderer.h"
#include "engine/splatting/splat_pass.h"
#include "engine/validation/fly_through.h"
#include "engine/volume/procedural.h"
#include "engine/volume/subject.h"

namespace freevoxels::bench {

namespace {

/// Voxel (0, 0, 0) at the origin, cubic voxels of world size 1.
Volume unitVoxels(glm::ivec3 dimensions, float (*valueAt)(int, int, int)) {
  return makeVolume(dimensions, glm::dmat4(1.0), valueAt);
}

double total(const Commands& commands) {
  double sum = 0.0;
  for (const StageTime& time : commands.times()) sum += time.milliseconds;
  return sum;
}

double passTime(const std::vector<StageTime>& times, std::string_view name) {
  double sum = 0.0;
  for (const StageTime& time : times)
    if (time.name == name) sum += time.milliseconds;
  return sum;
}

/// Milliseconds of the passes of the last frame.
struct PassTimes {
  double cut = 1e30, draw = 1e30;
  double total() const { return cut + draw; }
};
PassTimes passTimes(const Renderer& renderer) {
  const std::vector<StageTime> times = renderer.timings();
  return {.cut = passTime(times, "level of detail and culling"),
          .draw = passTime(times, "splat set-up") + passTime(times, "splat draw")};
}

std::uint64_t drawnSplats(const Renderer& renderer) {
  const std::vector<std::uint64_t> drawn = renderer.cutCounts().drawn;
  return std::accumulate(drawn.begin(), drawn.end(), std::uint64_t(0));
}

Lighting directionalLights(int count) {
  Lighting lighting;
  for (int i = 0; i < count; ++i) lighting.lights.push_back({.place = {std::cos(0.4 * i), 0.5, std::sin(0.4 * i)}});
  return lighting;
}

/// Milliseconds from a volume in memory to its first image of 1024 x 1024 pixels in memory.
double firstImage(const Device& device, const Volume& volume, const Classification& classification, bool lit,
                  int runs) {
  FrameSettings settings{.size = {1024, 1024}};
  if (lit) settings.lighting = directionalLights(1);
  const Camera camera = framingCamera(volume, kDefaultAzimuth, kDefaultElevation, 1.0, {});
  return least(runs, [&] {
    return millisecondsOf([&] { Renderer(device, volume, classification, {}).render(camera, settings); });
  });
}

BuiltVolume built(const Device& device, const Volume& volume) {
  std::vector<StageTime> times;
  return buildVolume(device, volume, {.densityScale = 0.01}, times);
}

/// Densities that differ from voxel to voxel.
Volume stripes(int resolution) {
  return unitVoxels(glm::ivec3(resolution),
                    [](int x, int y, int z) { return float((x + 2 * y + 3 * z) % 7); });
}

}  // namespace

Result sweeps(const Device& device, DirectionSet directions, int resolution, int runs) {
  const Volume volume = stripes(resolution);
  const BuiltVolume onDevice = built(device, volume);
  const AttenuationTable table = makeTable(device, onDevice.volume, {.directions = directions});
  AttenuationSweep sweep(device, table.settings);
  const double time = least(runs, [&] {
    Commands commands(device);
    sweep.record(commands, onDevice.volume, table);
    commands.submitAndWait();
    return total(commands);
  });
  const auto count = std::uint64_t(directionCount(directions));
  return {.name = fmt::format("{0} sweeps, {1}x{1}x{1}", count, resolution),
          .milliseconds = time,
          .copyMilliseconds = copyTime(device, (count + 1) * volume.voxelCount()),
          .perSecond = double(count * volume.voxelCount()) / time * 1e3};
}

Result octree(const Device& device, std::string_view name, AttenuationCode code, int resolution, int runs) {
  const Volume volume = name == kStripes ? stripes(resolution) : makeProcedural(name, resolution);
  const BuiltVolume onDevice = built(device, volume);
  const AttenuationTable table = makeTable(device, onDevice.volume, {.code = code});
  AttenuationSweep sweep(device, table.settings);
  const MediumLevels medium(device, onDevice.volume, levelDispatches(device));
  TableLevels levels(device, table.settings);
  double sweeps = std::numeric_limits<double>::max();
  const double time = least(runs, [&] {
    Commands before(device), commands(device);
    sweep.record(before, onDevice.volume, table);
    before.submitAndWait();
    sweeps = std::min(sweeps, total(before));
    medium.record(commands, onDevice.volume, onDevice.lists.steps);
    levels.record(commands, onDevice.volume, onDevice.lists.steps, table);
    commands.submitAndWait();
    return total(commands);
  });
  const std::uint64_t voxels = onDevice.volume.stored.front();
  return {.name = fmt::format("octree of {0}, {1}^3, {2}: {3:.2f} of the sweeps", name, resolution,
                              code == AttenuationCode::Depth8 ? "depth8" : "linear8", time / sweeps),
          .milliseconds = time,
          .copyMilliseconds = copyTime(device, 27 * voxels),
          .perSecond = 26.0 * double(voxels) / time * 1e3};
}

std::vector<Result> zoom(const Device& device, int resolution, int runs) {
  Volume volume = makeProcedural("cloud", resolution);
  Renderer renderer(device, volume, {.densityScale = automaticDensityScale(volume, 2.0)}, {});
  const glm::ivec2 size(1024);
  Camera camera = framingCamera(volume, kDefaultAzimuth, kDefaultElevation, 1.0, {});
  const glm::dvec3 toEye = glm::normalize(camera.position - camera.lookAt);
  const double height = 2.0 * std::tan(camera.verticalFov * std::numbers::pi / 360.0);
  std::vector<Result> results;
  for (const double pixels : {4.0, 1.0, 0.5, 0.25, 0.125})
    for (const float lod : {0.0f, 1.0f}) {
      camera.position = camera.lookAt + size.y * volume.voxelSize() / (height * pixels) * toEye;
      renderer.render(camera, {.size = size, .method = SplatSettings{}, .lod = lod});  // what is made once
      const double time = least(runs, [&] {
        renderer.render(camera, {.size = size, .method = SplatSettings{}, .lod = lod});
        return passTimes(renderer).total();
      });
      results.push_back({.name = fmt::format("cloud {}^3, {:g} pixels a voxel, --lod {:g}: {} splats",
                                             resolution, pixels, lod, drawnSplats(renderer)),
                         .milliseconds = time});
    }
  return results;
}

std::vector<Result> culling(const Device& device, QualityColor color, int resolution, int runs) {
  const QualityScene scene =
      makeQualityScene({"head", color, false}, resolution, makeProcedural("head", resolution));
  Renderer renderer(device, scene.volume, scene.classification, {});
  const Camera camera = framingCamera(scene.volume, kDefaultAzimuth, kDefaultElevation, 1.0, {});
  std::vector<Result> results;
  for (const bool culled : {false, true}) {
    const FrameSettings settings{.size = glm::ivec2(1024), .method = SplatSettings{.composite = Composite::Additive, .culling = culled}};
    renderer.render(camera, settings);  // what is made once
    PassTimes best;
    least(runs, [&] {
      renderer.render(camera, settings);
      const PassTimes times = passTimes(renderer);
      if (times.total() < best.total()) best = times;
      return times.total();
    });
    results.push_back(
        {.name = fmt::format("{} head {}^3{}: {} splats, {:.3f} of it choosing them",
                             color == QualityColor::Skin ? "opaque" : "bone", resolution,
                             culled ? ", culled" : "", drawnSplats(renderer), best.cut / best.total()),
         .milliseconds = best.total()});
  }
  return results;
}

std::vector<Result> frames(const Device& device, std::string_view name, int resolution, int runs) {
  const bool head = name == "head";
  const QualityScene scene = makeQualityScene({head ? "head" : "cloud", head ? QualityColor::Bone : QualityColor::Cloud, false},
                                              resolution, makeProcedural(std::string(name), resolution));
  Renderer renderer(device, scene.volume, scene.classification, {});
  const Camera camera = framingCamera(scene.volume, kDefaultAzimuth, kDefaultElevation, 1.0, {});
  std::vector<Result> results;
  for (const bool lit : {false, true})
    for (const Draw draw : {Draw::Gather, Draw::Splats}) {
      FrameSettings settings{.size = {1024, 1024}};
      if (draw == Draw::Splats) settings.method = SplatSettings{};
      if (lit) settings.lighting = directionalLights(1);
      renderer.render(camera, settings);  // what is made once
      const double time = least(runs, [&] { return millisecondsOf([&] { renderer.render(camera, settings); }); });
      const std::string ratio = draw == Draw::Splats
                                    ? fmt::format(": {:.1f} of the gather", time / results.back().milliseconds)
                                    : "";
      results.push_back({.name = fmt::format("frame of {} {}^3, {}, {}{}", name, resolution, lit ? "one light" : "unlit",
                                             draw == Draw::Gather ? "gather" : "splats", ratio),
                         .milliseconds = time});
    }
  return results;
}

Result turntable(const Device& device, std::string_view name, int resolution, glm::ivec2 size, int lights, int runs) {
  constexpr int kFrames = 12;
  const bool head = name == "head";
  const QualityScene scene = makeQualityScene(
      {head ? "head" : "cloud", head ? QualityColor::Bone : QualityColor::Cloud, false}, resolution,
      makeProcedural(std::string(name), resolution));
  Renderer renderer(device, scene.volume, scene.classification, {});
  FrameSettings settings{.size = size};
  if (lights > 0) settings.lighting = directionalLights(lights);
  const auto cameraOf = [&](int frame) {
    return framingCamera(scene.volume, kDefaultAzimuth + 5.0 * frame, kDefaultElevation, double(size.x) / size.y, {});
  };
  renderer.render(cameraOf(0), settings);  // what is made once
  const double time = least(runs, [&] {
    return millisecondsOf([&] {
      for (int frame = 1; frame <= kFrames; ++frame) renderer.render(cameraOf(frame), settings);
    });
  });
  return {.name = fmt::format("turntable of {} {}^3, {}x{}, {} light{}", name, resolution, size.x, size.y, lights,
                              lights == 1 ? "" : "s"),
          .milliseconds = time / kFrames};
}

std::vector<Result> lights(const Device& device, int resolution, int runs) {
  const Volume volume = makeProcedural("cloud", resolution);
  const Classification classification{.densityScale = automaticDensityScale(volume, 2.0)};
  const Camera camera = framingCamera(volume, kDefaultAzimuth, kDefaultElevation, 1.0, {});
  std::vector<Result> results;
  const auto measure = [&](int count, LightAttenuation attenuation) {
    FrameSettings settings{.size = {1024, 1024}, .lighting = directionalLights(count)};
    settings.lighting->attenuation = attenuation;
    const double time = least(runs, [&] {
      std::vector<StageTime> times;
      {
        const StageTimer timer(times, "whole");
        Renderer(device, volume, classification, {}).render(camera, settings);
      }
      return times.front().milliseconds;
    });
    const std::string ratio =
        results.empty() ? "" : fmt::format(": {:.2f} of one light", time / results.front().milliseconds);
    results.push_back(
        {.name = fmt::format("cloud {}^3, {} light{}, {}, whole{}", resolution, count, count == 1 ? "" : "s",
                             attenuation == LightAttenuation::Table ? "table" : "exact", ratio),
         .milliseconds = time});
  };
  measure(1, LightAttenuation::Table);
  measure(16, LightAttenuation::Table);
  for (const int count : {1, 16}) measure(count, LightAttenuation::Exact);
  return results;
}

Result compaction(const Device& device, int resolution, int runs) {
  const Volume volume = unitVoxels(glm::ivec3(resolution), [](int x, int y, int z) {
    return ((x / 8) * 7 + (y / 8) * 13 + (z / 8) * 29) % 32 == 0 ? 1.0f : 0.0f;
  });
  const BuiltVolume onDevice = built(device, volume);
  BlockList list;
  const Buffer totals(device, sizeof(std::uint32_t), MemoryUse::Device, "block counts");
  const CompactionPass pass(device);
  pass.allocate(list, onDevice.volume.stored.front());
  const std::array<BlockList*, 1> lists{&list};
  const double time = least(runs, [&] {
    Commands commands(device);
    pass.recordCounts(commands, onDevice.volume, lists, totals);
    pass.recordLists(commands, onDevice.volume, lists);
    commands.submitAndWait();
    return total(commands);
  });
  return {.name = fmt::format("list of {} occupied of {}^3 voxels", onDevice.volume.stored.front(), resolution),
          .milliseconds = time,
          .copyMilliseconds = copyTime(device, volume.voxelCount() / 4 + 4 * onDevice.volume.stored.front()),
          .perSecond = double(volume.voxelCount()) / time * 1e3};
}

Result splats(const Device& device, double pixels, int runs) {
  const glm::ivec3 dimensions(316, 316, 5);
  const Volume volume = unitVoxels(dimensions, [](int, int, int) { return 1.0f; });
  Renderer renderer(device, volume, {.densityScale = 0.1}, {});
  const FrameSettings settings{.size = {1024, 1024}, .method = SplatSettings{}};
  Camera camera;
  camera.lookAt = 0.5 * glm::dvec3(dimensions - 1);
  camera.position = camera.lookAt + glm::dvec3(0.0, 0.0, 100.0);
  camera.orthographic = true;
  const double pixelsPerVoxel = pixels / (2.0 * double(shader::kSplatRadius));
  camera.orthographicHeight = double(settings.size.y) / pixelsPerVoxel;
  const double time = least(runs, [&] {
    renderer.render(camera, settings);
    return passTime(renderer.timings(), "splat draw");
  });
  return {.name = fmt::format("splat draw, {0} splats of {1:g}x{1:g} pixels", volume.voxelCount(), pixels),
          .milliseconds = time,
          .copyMilliseconds = 0.0,
          .perSecond = double(volume.voxelCount()) / time * 1e3};
}

Result wholeRender(const Device& device, const InputDescription& input, bool lit, int runs) {
  const Volume volume = input.open(maximumVoxels(device));
  const Classification classification{.densityScale = automaticDensityScale(volume, 2.0)};
  const glm::ivec3 box = volume.dimensions;
  return {.name = fmt::format("first image of {}, {}x{}x{}, {}", volume.source, box.x, box.y, box.z,
                              lit ? "one light" : "unlit"),
          .milliseconds = firstImage(device, volume, classification, lit, runs)};
}

Result wholeScan(const Device& device, int resolution, bool lit, int runs) {
  const QualityScene scene =
      makeQualityScene({"head", QualityColor::Bone, false}, resolution, makeProcedural("head", resolution));
  return {.name = fmt::format("first image of a dense scan, {}^3, {}", resolution, lit ? "one light" : "unlit"),
          .milliseconds = firstImage(device, scene.volume, scene.classification, lit, runs)};
}

std::vector<Result> edits(const Device& device, int resolution, int runs) {
  QualityScene scene = makeQualityScene({"head", QualityColor::Bone, false}, resolution, makeProcedural("head", resolution));
  scene.classification.order = ClassificationOrder::Post;
  Renderer renderer(device, scene.volume, scene.classification, {});
  FrameSettings whole{.size = {1280, 800}, .lighting = directionalLights(1)}, draft = whole;
  draft.size = whole.size / 5;
  draft.lod = 0.2f;
  draft.quality = 0.5;
  draft.allowsOldLight = true;
  const Camera camera = framingCamera(scene.volume, kDefaultAzimuth, kDefaultElevation, 1.6, {});
  renderer.render(camera, whole);
  Classification edited = scene.classification;
  int edit = 0;
  const auto turn = [&] {
    for (TransferFunction::OpacityPoint& point : edited.transferFunction->opacity) point.opacity *= ++edit % 2 == 1 ? 0.9f : 1.0f / 0.9f;
    FV_CHECK_EQ(renderer.reclassify(edited), true);
  };
  std::vector<Result> results;
  const auto add = [&](const char* name, const FrameSettings& settings) {
    const double time = least(runs, [&] {
      return millisecondsOf([&] {
        turn();
        renderer.render(camera, settings);
      });
    });
    results.push_back(
        {.name = fmt::format("edit of a function, dense scan {}^3, {}x{}, {}", resolution, settings.size.x, settings.size.y, name),
         .milliseconds = time});
  };
  add("draft", draft);
  add("whole", whole);
  for (const bool lit : {false, true}) {
    FrameSettings small{.size = {256, 256}};
    if (lit) small.lighting = whole.lighting;
    const double time = least(runs, [&] { return millisecondsOf([&] { renderer.render(camera, small); }); });
    results.push_back(
        {.name = fmt::format("small frame, dense scan {}^3, 256x256, {}", resolution, lit ? "one light" : "unlit"), .milliseconds = time});
  }
  return results;
}

std::vector<Result> flight(const Device& device, int resolution, int runs) {
  constexpr int kFrames = 12;
  const Volume volume = makeProcedural("cloud", resolution);
  Renderer renderer(device, volume, {.densityScale = automaticDensityScale(volume, 2.0)}, {});
  const FrameSettings settings{.size = {512, 512}};
  double sum[2] = {0.0, 0.0};
  int frames[2] = {0, 0};
  for (const Camera& camera : flyThrough(volume, kFrames)) {
    const bool inside = eyeIsInside(camera, volume.dimensions, volume.indexToWorld);
    renderer.render(camera, settings);  // makes what is made once
    sum[inside] += least(runs, [&] { return millisecondsOf([&] { renderer.render(camera, settings); }); });
    ++frames[inside];
  }
  std::vector<Result> results;
  for (const bool inside : {false, true})
    results.push_back({.name = fmt::format("flight through {}, eye {}, 512x512", volume.source,
                                           inside ? "inside" : "outside"),
                       .milliseconds = sum[inside] / frames[inside],
                       .copyMilliseconds = 0.0,
                       .perSecond = 0.0});
  return results;
}

}  // namespace freevoxels::bench
