#include "apps/freevoxels/oracle_command.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <chrono>

#include "apps/freevoxels/progress_line.h"
#include "apps/freevoxels/timings_file.h"
#include "engine/core/error.h"
#include "engine/reference/oracle.h"

namespace freevoxels {

namespace {

constexpr const char* kExamples =
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
  messages_.add(*command);
  command->footer(kExamples);
  command->callback([this] { run(); });
}

void OracleCommand::run() {
  messages_.apply();
  scene_.takeScene("");
  scene_.check();
  draw();
  if (messages_.quiet) return;
  for (const std::string& file : scene_.output.files) fmt::print("{}\n", file);
  if (scene_.file.saved) fmt::print("{}\n", *scene_.file.saved);
}

std::uint64_t OracleCommand::voxelsThatFit() const {
  const glm::ivec2 size = scene_.camera.size;
  const std::uint64_t machine = machineMemoryBytes();
  const std::uint64_t picture = std::uint64_t(size.x) * std::uint64_t(size.y) * kOracleBytesPerPixel;
  if (picture >= machine)
    fail(ErrorKind::OutOfMemory,
         "a picture of {}x{} pixels needs {} bytes, and this machine has {}: lower --size", size.x, size.y,
         picture, machine);
  const LightingOptions& lighting = scene_.lighting;
  const bool colored = lighting.environment || (lighting.ambient && lighting.tint);
  const std::uint64_t channels = colored ? 3 : lighting.ambient ? 1 : 0;
  const std::uint64_t ambient = channels * kOracleAmbientBytesPerVoxel;
  const std::uint64_t light = scene_.emission.grid() ? kOracleLightBytesPerVoxel : 0;
  const std::uint64_t albedo = scene_.classification.albedoGrid ? kOracleAlbedoBytesPerVoxel : 0;
  return (machine - picture) / (kOracleBytesPerVoxel + ambient + light + albedo);
}

void OracleCommand::draw() const {
  const std::uint64_t maximum = voxelsThatFit();
  ProgressLine line(!messages_.quiet);
  line.begin("reading " + scene_.input.input);
  const Scene scene = scene_.open(maximum);
  const OptionList options = scene_.describe(scene);
  line.erase();
  scene_.warn(scene);
  logOptions(options);

  const auto start = std::chrono::steady_clock::now();
  const OracleSettings settings{
      .size = scene_.camera.size, .depth = scene_.output.wantsDepth(), .lighting = scene.lighting};
  const Oracle oracle =
      renderOracle(*scene.volume, scene.classification, scene.camera, settings, line.progress());
  line.erase();
  logOracle(oracle, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  if (!oracle.converged)
    spdlog::warn("a pixel still changed by {:.2g} from {}x{} to {}x{} rays; a larger --size shows more",
                 oracle.largestChange, oracle.samples / 2, oracle.samples / 2, oracle.samples,
                 oracle.samples);

  line.begin("writing pictures");
  scene_.write(oracle.image, scene, "oracle", options,
               {{"samples", fmt::format("{0}x{0}", oracle.samples)},
                {"largest-change", numberText(oracle.largestChange)}});
  scene_.save(options);
}

}  // namespace freevoxels
