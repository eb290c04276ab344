#include "engine/volume/transfer_source.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/core/json_file.h"
#include "engine/core/nearest_name.h"
#include "engine/core/printable.h"
#include "engine/volume/transfer_formats.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFile = std::uintmax_t(1) << 24;
constexpr const char* kKind = "transfer function";

/// Whether there is something to read: folders may have the names of presets.
bool isFile(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error) && !fs::is_directory(file, error);
}

/// FILE and NAME of FILE:NAME, where there is such a file; nothing else.
std::optional<std::pair<std::string, std::string>> fileAndName(const std::string& text) {
  for (std::size_t colon = text.find(':'); colon != text.npos; colon = text.find(':', colon + 1)) {
    std::error_code error;
    if (colon > 0 && fs::is_regular_file(text.substr(0, colon), error)) return std::pair(text.substr(0, colon), text.substr(colon + 1));
  }
  return std::nullopt;
}

TransferCurves readFile(const fs::path& file, const std::string& wanted) {
  checkInputFile(kKind, file);
  std::error_code error;
  if (const std::uintmax_t size = fs::file_size(file, error); !error && size > kMaxFile)
    fail(ErrorKind::Input, "'{}' has {} MiB, and no transfer function has; name another file", file.string(), size >> 20);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(ErrorKind::Input, "cannot open {} '{}'; check its permissions", kKind, file.string());
  return readTransferText({.name = file.string(), .text = std::string(std::istreambuf_iterator<char>(stream), {}), .wanted = wanted});
}

/// A name in the spelling of presets.
std::string presetSpelling(std::string_view name) {
  std::string spelled(name);
  std::ranges::transform(spelled, spelled.begin(), [](unsigned char c) { return c == '_' || c == ' ' ? '-' : char(std::tolower(c)); });
  return spelled;
}

/// Refuses a text that is neither a file nor a preset.
[[noreturn]] void failUnknown(const std::string& text) {
  std::error_code error;
  if (text.find_first_of("./\\") != text.npos || text.empty() || fs::exists(text, error)) checkInputFile(kKind, text);
  std::vector<std::string> names;
  for (const TransferPreset& preset : transferPresets()) names.emplace_back(preset.name);
  fail(ErrorKind::Input, "there is neither a file nor a preset '{}'{}; 'freevoxels presets' lists the presets", quotedPart(text),
       suggestion(presetSpelling(text), names));
}

}  // namespace

const TransferPreset* presetNamed(std::string_view name) {
  const auto found = std::ranges::find(transferPresets(), presetSpelling(name), &TransferPreset::name);
  return found == transferPresets().end() ? nullptr : &*found;
}

std::string presetsJson() {
  nlohmann::ordered_json functions = nlohmann::ordered_json::object();
  for (const TransferPreset& preset : transferPresets()) functions[std::string(preset.name)] = nlohmann::ordered_json::parse(preset.json);
  return functions.dump(2);
}

TransferCurves curvesOf(const TransferPreset& preset) {
  return parseTransferCurves(std::string(preset.name), std::string(preset.json));
}

TransferCurves readTransferCurves(const std::string& text) {
  if (text.starts_with('{')) return readTransferText({.name = "inline", .text = text, .wanted = {}});
  if (isFile(text)) return readFile(text, "");
  if (const auto parts = fileAndName(text)) return readFile(parts->first, parts->second);
  if (const TransferPreset* const preset = presetNamed(text)) return curvesOf(*preset);
  failUnknown(text);
}

std::string transferFile(const std::string& text) {
  if (text.starts_with('{')) return "";
  if (isFile(text)) return text;
  const auto parts = fileAndName(text);
  return parts ? parts->first : "";
}

std::string transferNameIn(const std::string& folder, const std::string& text) {
  if (text.starts_with('{')) return text;
  const fs::path file = fs::path(folder) / text;
  if (presetNamed(text) != nullptr && !isFile(file)) return text;
  if (const auto parts = fileAndName(file.string())) return fs::path(parts->first).lexically_normal().string() + ":" + parts->second;
  return file.lexically_normal().string();
}

std::vector<std::string> transferWarnings(const std::string& text) {
  std::vector<std::string> sentences;
  for (const std::string& clause : readTransferCurves(text).warnings)
    sentences.push_back(fmt::format("transfer function '{}': {}", text.starts_with('{') ? "inline" : quotedPart(text), clause));
  return sentences;
}

}  // namespace freevoxels
