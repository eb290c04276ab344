#include "apps/freevoxels/input_options.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "apps/freevoxels/failure.h"
#include "engine/storage/baked_volume.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

namespace {

constexpr std::string_view kProceduralPrefix = "procedural:";

Volume openBaked(const std::shared_ptr<const fvx::FvxFile>& file, std::uint64_t maximumVoxels, int level) {
  const int fitting = finestLevel(*file, maximumVoxels);
  Volume volume = readBaked(file, std::max(fitting, level));
  if (fitting > level)
    volume.warnings.push_back(fmt::format("{} is opened at 1/{} of its resolution: the {} voxels of its box are more than the {} that fit",
                                          file->path().string(), 1 << fitting, resolutionText(file->dimensions(0)), maximumVoxels));
  return volume;
}

std::string clipText(const VoxelBox& box) {
  return fmt::format("{},{},{},{},{},{}", box.first.x, box.first.y, box.first.z, box.last.x, box.last.y, box.last.z);
}

std::string clipText(const ClipPlane& plane) {
  return fmt::format("{},{},{},{},{},{}", plane.point.x, plane.point.y, plane.point.z, plane.normal.x, plane.normal.y, plane.normal.z);
}

}  // namespace

std::uint64_t machineMemoryBytes() {
  return std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGESIZE));
}

CLI::Option* addResolution(CLI::App& app, std::optional<glm::ivec3>& target) {
  return addDimensions(app, "--resolution", target, kMostResolution,
                       fmt::format("Voxels of a procedural volume, one number for a cube [{}]", kDefaultResolution));
}

std::string resolutionText(glm::ivec3 dimensions) {
  const bool isCube = dimensions == glm::ivec3(dimensions.x);
  return isCube ? fmt::format("{}", dimensions.x) : fmt::format("{}x{}x{}", dimensions.x, dimensions.y, dimensions.z);
}

std::optional<std::string> proceduralName(const std::string& input) {
  if (!input.starts_with(kProceduralPrefix)) return std::nullopt;
  return input.substr(kProceduralPrefix.size());
}

Volume openProcedural(const std::string& name, std::optional<glm::ivec3> resolution, std::uint64_t maximumVoxels) {
  const glm::ivec3 dimensions = resolution.value_or(glm::ivec3(kDefaultResolution));
  const std::uint64_t needed = std::uint64_t(dimensions.x) * std::uint64_t(dimensions.y) * std::uint64_t(dimensions.z);
  const std::uint64_t available =
      std::min<std::uint64_t>(maximumVoxels, machineMemoryBytes() / sizeof(float));
  if (needed > available)
    fail(ErrorKind::OutOfMemory,
         "procedural:{} has {} voxels at --resolution {}, and {} fit: lower --resolution", name, needed,
         resolutionText(dimensions), available);
  Volume volume = makeProcedural(name, dimensions);
  cropToActive(volume);
  return volume;
}

void InputOptions::add(CLI::App& app) {
  app.add_option(
         "IN", input,
         "OpenVDB file, baked volume (.fvx), or procedural:NAME ('freevoxels generate --list' has the names); may be left "
         "out where a --scene has it")
      ->group("Input");
  addResolution(app, resolution)->group("Input");
}

void InputOptions::addGrid(CLI::App& app) {
  addText(app, "--grid", "NAME", grid,
          "Grid of the file, NAME[k] if several have the name [density, or the only float grid]")
      ->group("Input");
}

void InputOptions::addClip(CLI::App& app) {
  app.add_option_function<std::string>(
         "--clip-box",
         [this](const std::string& text) {
           constexpr int kLargest = 1 << 20;  // beyond any volume
           const std::vector<double> n = readNumbers("--clip-box", "X0,Y0,Z0,X1,Y1,Z1", 6, text, {0.0, double(kLargest)});
           clipBox = VoxelBox{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
         },
         "Draw only these voxels: the first and the last ones along x, y and z, inclusive, in the volume's box, whose voxels "
         "'freevoxels info' counts")
      ->take_last()
      ->type_name("X0,Y0,Z0,X1,Y1,Z1")
      ->group("Input");
  app.add_option_function<std::string>(
         "--clip-plane",
         [this](const std::string& text) {
           const std::vector<double> n = readNumbers("--clip-plane", "X,Y,Z,NX,NY,NZ", 6, text, {-1e30, 1e30});
           clipPlane = ClipPlane{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
         },
         "Draw only the voxels behind the plane through the world position X,Y,Z: the side away from its normal NX,NY,NZ")
      ->take_last()
      ->type_name("X,Y,Z,NX,NY,NZ")
      ->group("Input");
}

void InputOptions::checkGiven() const {
  if (input.empty()) fail(ErrorKind::Usage, "IN is required: name an OpenVDB file, or procedural:NAME");
}

void InputOptions::check() const {
  if (grid && !proceduralName(input) && fvx::isFvx(input))
    fail(ErrorKind::Usage, "--grid chooses among the grids of an OpenVDB file, and '{}' is a baked volume", input);
  if (clipBox && glm::any(glm::greaterThan(clipBox->first, clipBox->last)))
    fail(ErrorKind::Usage, "--clip-box {} is empty: give the smaller coordinates first", clipText(*clipBox));
  if (clipPlane && glm::length(clipPlane->normal) < 1e-30)
    fail(ErrorKind::Usage, "--clip-plane {} has a normal of length 0: give one such as 1,0,0", clipText(*clipPlane));
  if ((clipBox || clipPlane) && !proceduralName(input) && fvx::isFvx(input))
    fail(ErrorKind::Usage, "{} does not apply to a baked volume such as '{}': clip the volume that it is baked of",
         clipBox ? "--clip-box" : "--clip-plane", input);
  if (proceduralName(input)) {
    if (grid) fail(ErrorKind::Usage, "--grid chooses among the grids of a file, and {} has one", input);
  } else if (resolution) {
    fail(ErrorKind::Usage, "--resolution is for procedural:NAME, and '{}' has the resolution of its grid",
         input);
  }
}

std::shared_ptr<const fvx::FvxFile> InputOptions::baked() const {
  if (proceduralName(input) || !fvx::isFvx(input)) return nullptr;
  return std::make_shared<const fvx::FvxFile>(input);
}

Volume InputOptions::open(std::uint64_t maximumVoxels, const MoreGrids& more, int level) const {
  const std::optional<std::string> name = proceduralName(input);
  if (const auto file = baked()) return openBaked(file, maximumVoxels, level);
  if (!name) return clip(readVdb(input, grid.value_or(""), maximumVoxels, more));
  Volume volume = openProcedural(*name, resolution, maximumVoxels);
  if (!more.temperature) volume.temperature.reset();
  return clip(std::move(volume));
}

Volume InputOptions::clip(Volume volume) const {
  const glm::ivec3 size = volume.dimensions;
  if (clipBox && glm::any(glm::greaterThanEqual(clipBox->first, size)))
    fail(ErrorKind::Usage, "--clip-box {} has no voxel of the volume's box, which has {} x {} x {}", clipText(*clipBox), size.x, size.y,
         size.z);
  if (clipBox) volume = clippedVolume(volume, *clipBox);
  if (!clipPlane) return volume;
  const bool hadVoxels = volume.activeVoxels > 0;
  volume = clippedVolume(volume, *clipPlane);
  if (hadVoxels && volume.activeVoxels == 0)
    fail(ErrorKind::Usage, "--clip-plane {} has no voxel behind it: move it, or turn its normal round", clipText(*clipPlane));
  return volume;
}

void InputOptions::describe(OptionList& options) const {
  options.emplace_back("", input);
  if (grid) options.emplace_back("--grid", *grid);
  if (proceduralName(input))
    options.emplace_back("--resolution", resolutionText(resolution.value_or(glm::ivec3(kDefaultResolution))));
  if (clipBox) options.emplace_back("--clip-box", clipText(*clipBox));
  if (clipPlane) options.emplace_back("--clip-plane", clipText(*clipPlane));
}

std::vector<std::string> warningsOf(const Volume& volume, bool scalarsAreDensities) {
  std::vector<std::string> warnings = volume.warnings;
  const auto warn = [&](std::uint64_t voxels, const char* what) {
    if (voxels == 0) return;
    const bool one = voxels == 1;
    warnings.push_back(fmt::format("{} voxel{} of {} with {} count{} as 0", voxels, one ? "" : "s", volume.source, what, one ? "s" : ""));
  };
  warn(volume.nanVoxels, "a value that is NaN or infinite");
  if (volume.albedo && volume.albedo->clippedVoxels > 0)
    warnings.push_back(fmt::format("{} voxels of grid '{}' have components outside of 0..1, which are clipped to it",
                                   volume.albedo->clippedVoxels, volume.albedo->name));
  if (scalarsAreDensities) warn(volume.negativeVoxels, "negative density");
  return warnings;
}

void logWarnings(const Volume& volume, bool scalarsAreDensities) {
  for (const std::string& warning : warningsOf(volume, scalarsAreDensities)) spdlog::warn("{}", withOptions(warning));
}

}  // namespace freevoxels
