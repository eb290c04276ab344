#include "apps/freevoxels/commands.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <chrono>

#include "apps/common/progress_line.h"
#include "apps/common/timings_file.h"
#include "engine/core/error.h"
#include "engine/core/machine.h"
#include "engine/reference/oracle.h"

namespace freevoxels {

namespace {

constexpr const char* kOracleExamples =
    "Examples:\n"
    "  freevoxels oracle cloud.vdb truth.exr --float --size 512x512\n"
    "  freevoxels oracle procedural:head truth.exr --aov depth --transfer-function bone.json\n"
    "Takes minutes where render takes seconds; needs no Vulkan device.\n";

void logOracle(const Oracle& oracle, double seconds) {
  spdlog::debug("{0}x{0} rays in the pixels that needed most, {1:.1f} a pixel on average", oracle.samples,
                double(oracle.rays) / double(oracle.image.pixels.size()));
  spdlog::debug("largest change of a pixel by its last doubling: {:.2g}", oracle.largestChange);
  spdlog::debug("{:.1f} s for {} rays", seconds, oracle.rays);
}

}  // namespace

void OracleCommand::add(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("oracle", "Draw a reference image by ray marching in double precision, for comparison");
  scene_.add(*command);
  scene_.addFields(*command, {"mode"});
  messages_.add(*command);
  command->footer(kOracleExamples);
  command->callback([this] { run(); });
}

void OracleCommand::run() {
  messages_.apply();
  scene_.takeScene("");
  scene_.description.lighting.shading = Shading::Scatter;  // the oracle has no surfaces
  const std::optional<std::string>& holdout = scene_.description.camera.holdout;
  scene_.check(scene_.files, {}, holdout ? std::vector{*holdout} : std::vector<std::string>{});
  draw();
  if (messages_.quiet) return;
  printNames(scene_.files);
  if (scene_.saved && !usesStandardOutput(scene_.files)) fmt::print("{}\n", *scene_.saved);
}

std::uint64_t OracleCommand::voxelsThatFit() const {
  const SceneDescription& description = scene_.description;
  const glm::ivec2 size = description.camera.size;
  const std::uint64_t machine = machineMemoryBytes();
  const std::uint64_t image = std::uint64_t(size.x) * std::uint64_t(size.y) * kOracleBytesPerPixel;
  if (image >= machine)
    fail(ErrorKind::OutOfMemory,
         "an image of {}x{} pixels needs {} bytes, and this machine has {}: lower --size", size.x, size.y,
         image, machine);
  const LightingDescription& lighting = description.lighting;
  const bool colored = lighting.environment || (lighting.ambient && lighting.tint);
  const std::uint64_t channels = colored ? 3 : lighting.ambient ? 1 : 0;
  const std::uint64_t ambient = channels * kOracleAmbientBytesPerVoxel;
  // Grids that are not asked for are read if they are there.
  const std::uint64_t light = description.emission.grid() ? kOracleLightBytesPerVoxel : 0;
  const std::uint64_t albedo = description.classification.grid() ? kOracleAlbedoBytesPerVoxel : 0;
  return (machine - image) / (kOracleBytesPerVoxel + ambient + light + albedo);
}

void OracleCommand::draw() const {
  const std::uint64_t maximum = voxelsThatFit();
  ProgressLine line(!messages_.quiet);
  const SceneDescription& description = scene_.description;
  line.begin("reading " + description.input.volume);
  const Scene scene = description.resolve(std::make_shared<const Volume>(description.readVolume(maximum)));
  const SceneDescription resolved = description.resolved(scene);
  const OptionList options = scene_.ownOptions(resolved);
  line.erase();
  logRemarks(description, scene);
  logOptions(options);

  const auto start = std::chrono::steady_clock::now();
  if (description.output.aovs.hasLayers())
    fail(ErrorKind::Usage, "the oracle has no layers: leave lights and channels out of {}", Parameter("aov"));
  const OracleSettings settings{.size = description.camera.size,
                                .depth = description.output.aovs.needDepth(),
                                .lighting = scene.lighting,
                                .projection = description.method.mode.value_or(IntensityProjection::None),
                                .holdout = description.camera.readHoldout()};
  std::vector<PlacedMedium> volumes{{scene.volume.get(), &scene.classification}};
  for (const SceneVolume& added : scene.added) volumes.push_back({known(added.source).get(), &added.classification});
  const Oracle oracle = renderOracle(volumes, scene.camera, settings, line.progress());
  line.erase();
  logOracle(oracle, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  if (!oracle.converged)
    spdlog::warn("a pixel still changed by {:.2g} from {}x{} to {}x{} rays; a larger --size shows more",
                 oracle.largestChange, oracle.samples / 2, oracle.samples / 2, oracle.samples,
                 oracle.samples);

  line.begin("writing images");
  writeImages(oracle.image, description, scene_.files, scene, "oracle", options,
              {{"samples", fmt::format("{0}x{0}", oracle.samples)}, {"largest-change", numberText(oracle.largestChange)}});
  scene_.save(resolved);
}

}  // namespace freevoxels
