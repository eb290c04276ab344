#include "apps/view/opened_file.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "apps/view/view_options.h"
#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/description/scene_json.h"
#include "engine/volume/scan_file.h"
#include "engine/volume/transfer_formats.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

/// How files with transfer functions of other programs end; those in JSON are told by what is in them.
constexpr std::array kFunctionEndings{".vp", ".xml", ".mrml", ".1dt", ".itf", ".tfi"};

bool hasExtension(const std::string& file, const char* extension) {
  return std::filesystem::path(file).extension() == extension;
}

void openScene(ViewState& state, const std::string& file) {
  for (const std::string& warning : SceneFile(file).warnings()) spdlog::warn("{}", warning);
  SceneDescription scene = readScene(file);
  const std::optional<Sequence> sequence = takeVolume(scene);
  scene.camera.size = state.scene.camera.size;
  state.toneMapIsAutomatic = false;
  state.show(scene, sequence);
}

bool isTransferFunction(const std::string& file) {
  if (std::ranges::any_of(kFunctionEndings, [&](const char* ending) { return hasExtension(file, ending); })) return true;
  if (!hasExtension(file, ".json")) return false;
  const nlohmann::json json = readJson("scene or transfer function", file);
  return (json.is_object() && json.contains("opacity")) || isForeignJson(json);
}

void openTransferFunction(ViewState& state, const std::string& file) {
  for (const std::string& warning : transferWarnings(file)) spdlog::warn("{}", warning);
  state.scene.classification = {.transferFunction = file};
  state.changed = true;
}

bool isFlight(const std::string& file) {
  if (!hasExtension(file, ".json")) return false;
  const nlohmann::json json = readJson("scene, transfer function or flight", file);
  return json.is_object() && json.contains("keys");
}

void openFlight(ViewState& state, const std::string& file) {
  state.flight = readFlight(file);
  state.retoned = true;
  state.notice = fmt::format("{} keys of a flight: the panel View plays it", state.flight.keys.size());
}

void openVolume(ViewState& state, const std::string& file) {
  SceneDescription scene = state.scene;
  scene.input = {.volume = file};
  scene.classification = {};
  scene.emission = {};
  scene.added.clear();
  scene.camera = {.size = scene.camera.size};
  std::optional<Sequence> sequence;
  if (isPattern(file)) {
    sequence = findSequence(file);
    scene.input.volume = sequence->files.front();
  }
  scene.input.fixLevel(std::max(scene.camera.size.x, scene.camera.size.y));
  state.show(scene, sequence);
}

/// The sequence of a folder's first OpenVDB file, or that file; nothing of a folder without.
std::optional<std::string> volumeOfFolder(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code problem;
  for (std::filesystem::directory_iterator at(folder, problem), end; !problem && at != end; at.increment(problem))
    if (hasEnding(at->path(), {".vdb"})) files.push_back(at->path().string());
  if (files.empty()) return std::nullopt;
  const std::string first = *std::ranges::min_element(files);
  const std::optional<Sequence> sequence = sequenceAround(first);
  return sequence ? sequence->pattern : first;
}

}  // namespace

void openFile(ViewState& state, const std::string& opened) {
  const std::optional<std::string> ofFolder = std::filesystem::is_directory(opened) ? volumeOfFolder(opened) : std::nullopt;
  const std::string& file = ofFolder ? *ofFolder : opened;
  const bool named = proceduralName(file) || isPattern(file);
  if (!named && !std::filesystem::exists(file))
    fail(ErrorKind::Input, "cannot read '{}': there is no such file; check its name", file);
  if (!named && isTransferFunction(file)) return openTransferFunction(state, file);
  if (!named && isFlight(file)) return openFlight(state, file);
  if (named || hasExtension(file, ".vdb") || InputDescription{.volume = file}.kind() != VolumeKind::OpenVdb) return openVolume(state, file);
  if (hasExtension(file, ".exr") || hasExtension(file, ".hdr")) {
    state.scene.lighting.environment = file;
    state.changed = true;
  } else if (!hasExtension(file, ".json")) {
    fail(ErrorKind::Input,
         "'{}' cannot be shown: open a volume (.vdb, .fvx or a scan), a scene, a flight or a transfer function (.json, .vp, .xml, .1dt, "
         ".itf, .tfi), "
         "or the light around (.exr, .hdr)",
         file);
  } else {
    openScene(state, file);
  }
}

bool hasEnding(const std::filesystem::path& file, const std::vector<std::string>& endings) {
  std::string name = file.filename().string();
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return std::ranges::any_of(endings, [&](const std::string& ending) { return name.ends_with(ending); });
}

bool mayBeFrame(const std::filesystem::path& file) {
  return hasEnding(file, {".vdb"}) || (hasScanEnding(file) && !hasEnding(file, {".dcm", ".ima"}));
}

bool isWorthRemembering(const std::string& file) {
  return !proceduralName(file) && !hasExtension(file, ".exr") && !hasExtension(file, ".hdr") && !isTransferFunction(file) &&
         !isFlight(file);
}

}  // namespace freevoxels
