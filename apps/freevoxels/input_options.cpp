#include "apps/freevoxels/input_options.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "engine/core/error.h"
#include "engine/storage/baked_volume.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

namespace {

constexpr std::string_view kProceduralPrefix = "procedural:";

Volume openBaked(const std::string& input, std::uint64_t maximumVoxels) {
  const auto file = std::make_shared<const fvx::FvxFile>(input);
  const int level = finestLevel(*file, maximumVoxels);
  if (level > 0)
    spdlog::warn("{} is drawn at a {}th of its resolution: its {} x {} x {} voxels are more than the {} that fit", input, 1 << level,
                 file->dimensions(0).x, file->dimensions(0).y, file->dimensions(0).z, maximumVoxels);
  return readBaked(file, level);
}

}  // namespace

std::uint64_t machineMemoryBytes() {
  return std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGESIZE));
}

CLI::Option* addResolution(CLI::App& app, std::optional<int>& target) {
  return addWholeNumber(app, "--resolution", "N", target,
                        fmt::format("Voxels along an edge of a procedural volume [{}]", kDefaultResolution),
                        {1.0, 2048.0});
}

std::optional<std::string> proceduralName(const std::string& input) {
  if (!input.starts_with(kProceduralPrefix)) return std::nullopt;
  return input.substr(kProceduralPrefix.size());
}

Volume openProcedural(const std::string& name, std::optional<int> resolution, std::uint64_t maximumVoxels) {
  const auto edge = std::uint64_t(resolution.value_or(kDefaultResolution));
  const std::uint64_t needed = edge * edge * edge;
  const std::uint64_t available =
      std::min<std::uint64_t>(maximumVoxels, machineMemoryBytes() / sizeof(float));
  if (needed > available)
    fail(ExitCode::OutOfMemory,
         "procedural:{} has {} voxels at --resolution {}, and {} fit: lower --resolution", name, needed, edge,
         available);
  Volume volume = makeProcedural(name, int(edge));
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
          "Grid of the file, NAME[k] where several share it [density, or the only float grid]")
      ->group("Input");
}

void InputOptions::checkGiven() const {
  if (input.empty()) fail(ExitCode::Usage, "IN is required: name an OpenVDB file, or procedural:NAME");
}

void InputOptions::check() const {
  if (grid && !proceduralName(input) && fvx::isFvx(input))
    fail(ExitCode::Usage, "--grid chooses among the grids of an OpenVDB file, and '{}' is a baked volume", input);
  if (proceduralName(input)) {
    if (grid) fail(ExitCode::Usage, "--grid chooses among the grids of a file, and {} has one", input);
  } else if (resolution) {
    fail(ExitCode::Usage, "--resolution is for procedural:NAME, and '{}' has the resolution of its grid",
         input);
  }
}

Volume InputOptions::open(std::uint64_t maximumVoxels, const MoreGrids& more) const {
  const std::optional<std::string> name = proceduralName(input);
  if (!name && fvx::isFvx(input)) return openBaked(input, maximumVoxels);
  if (!name) return readVdb(input, grid.value_or(""), maximumVoxels, more);
  Volume volume = openProcedural(*name, resolution, maximumVoxels);
  if (!more.temperature) volume.temperature.reset();
  return volume;
}

void InputOptions::describe(OptionList& options) const {
  options.emplace_back("", input);
  if (grid) options.emplace_back("--grid", *grid);
  if (proceduralName(input))
    options.emplace_back("--resolution", std::to_string(resolution.value_or(kDefaultResolution)));
}

void warnAboutValues(const Volume& volume, bool scalarsAreDensities) {
  const auto warn = [&](std::uint64_t voxels, const char* what) {
    if (voxels == 0) return;
    const bool one = voxels == 1;
    spdlog::warn("{} voxel{} of {} with {} count{} as 0", voxels, one ? "" : "s", volume.source, what,
                 one ? "s" : "");
  };
  warn(volume.nanVoxels, "a value that is NaN or infinite");
  if (volume.albedo && volume.albedo->clippedVoxels > 0)
    spdlog::warn("{} voxels of grid '{}' have components outside of 0..1, which are clipped to it",
                 volume.albedo->clippedVoxels, volume.albedo->name);
  if (scalarsAreDensities) warn(volume.negativeVoxels, "negative density");
}

}  // namespace freevoxels
