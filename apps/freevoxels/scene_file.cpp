#include "apps/freevoxels/scene_file.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_value.h"
#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/core/nearest_name.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

/// Options that an option of the command line replaces in addition to those that it excludes.
struct Replaced {
  const char* option;
  std::vector<const char*> others;
};
const std::vector<Replaced> kReplaced{{"IN", {"--grid", "--resolution", "--clip-box", "--clip-plane"}},
                                      {"--shading", {"--surface-share"}},
                                      {"--paper",
                                       {"--composite", "--attenuation", "--directions", "--code",
                                        "--path-length-correction", "--gradient", "--lod", "--culling"}}};

std::string quoted(const std::string& section, const std::string& key) {
  return inQuotes(section.empty() ? key : section + "." + key);
}

/// The options of the command and of all other commands that accept scenes.
std::vector<const CLI::Option*> sceneOptions(const CLI::App& command) {
  std::vector<const CLI::Option*> options;
  std::vector<const CLI::App*> commands{&command};
  if (const CLI::App* program = command.get_parent())
    commands = program->get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* other : commands) {
    if (other->get_option_no_throw("--scene") == nullptr) continue;
    for (const CLI::Option* option : other->get_options())
      if (!sceneSection(*option).empty()) options.push_back(option);
  }
  return options;
}

/// A scene that is applied to a command.
class SceneReader {
 public:
  SceneReader(CLI::App& command, const std::string& file)
      : command_(command),
        file_(file),
        folder_(fs::path(file).parent_path()),
        root_(readJson("scene", file)) {
    if (!root_.is_object()) failHere("must be an object {{\"camera\": ...}}");
    for (const auto& [section, keys] : root_.items()) {
      if (!isSection(section)) failUnknown("", section);
      if (!keys.is_object())
        failHere("{} takes an object of keys, not {}", inQuotes(section), inQuotes(keys));
    }
  }

  bool hasVolume() const { return root_.contains("input") && root_["input"].contains("volume"); }
  void apply(const std::function<bool(const std::string&)>& wanted);

 private:
  template <typename... Args>
  [[noreturn]] void failHere(fmt::format_string<Args...> format, Args&&... args) const {
    fail(ErrorKind::Input, "scene '{}': {}", file_, fmt::format(format, std::forward<Args>(args)...));
  }
  [[noreturn]] void failUnknown(const std::string& section, const std::string& key) const;
  bool isSection(const std::string& name) const {
    return std::ranges::any_of(sceneOptions(command_),
                               [&](const CLI::Option* option) { return sceneSection(*option) == name; });
  }
  CLI::Option* find(const std::string& section, const std::string& key) const;
  std::set<const CLI::Option*> takenByCommandLine() const;
  void give(CLI::Option& option, const Json& value, const std::string& name) const;

  CLI::App& command_;
  const std::string file_;
  const fs::path folder_;
  const Json root_;
};

void SceneReader::failUnknown(const std::string& section, const std::string& key) const {
  std::string nearest;
  std::size_t least = kFarName;
  const auto consider = [&](std::size_t distance, const std::string& name) {
    if (distance < least) least = distance, nearest = name;
  };
  for (const CLI::Option* option : sceneOptions(command_)) {
    const std::string other = sceneSection(*option), known = sceneKey(*option);
    if (section.empty()) consider(editDistance(key, other), inQuotes(other));
    consider(editDistance(key, known) + (section == other ? 0 : 1), quoted(other, known));
  }
  failHere("there is no key {}{}", quoted(section, key),
           nearest.empty() ? "; apps/scenes/README.md has them all" : "; did you mean " + nearest + "?");
}

/// The option of a key; null if it is that of another command; fails for unknown keys.
CLI::Option* SceneReader::find(const std::string& section, const std::string& key) const {
  const auto is = [&](const CLI::Option* option) {
    return sceneSection(*option) == section && sceneKey(*option) == key;
  };
  const auto own = command_.get_options(is);
  if (!own.empty()) return own.front();
  if (std::ranges::none_of(sceneOptions(command_), is)) failUnknown(section, key);
  return nullptr;
}

std::set<const CLI::Option*> SceneReader::takenByCommandLine() const {
  std::set<const CLI::Option*> taken;
  for (const CLI::Option* option :
       command_.get_options([](const CLI::Option* o) { return o->count() > 0; })) {
    taken.insert(option);
    for (const CLI::Option* excluded : option->get_excludes()) taken.insert(excluded);
    for (const Replaced& replaced : kReplaced)
      if (optionName(*option) == replaced.option)
        for (const char* other : replaced.others) taken.insert(command_.get_option_no_throw(other));
  }
  return taken;
}

void SceneReader::give(CLI::Option& option, const Json& value, const std::string& name) const {
  const auto texts = optionTexts(option, value, folder_, fmt::format("scene '{}': {}", file_, name));
  if (texts.empty()) return;
  for (const std::string& text : texts) option.add_result(text);
  try {
    option.run_callback();
  } catch (const Error& error) {
    failHere("{}", error.text());
  }
}

void SceneReader::apply(const std::function<bool(const std::string&)>& wanted) {
  const std::set<const CLI::Option*> taken = takenByCommandLine();
  std::vector<const CLI::Option*> given;
  for (const auto& [section, keys] : root_.items())
    for (const auto& [key, value] : keys.items()) {
      CLI::Option* const option = find(section, key);
      if (option == nullptr || taken.contains(option) || !wanted(optionName(*option))) continue;
      give(*option, value, quoted(section, key));
      for (const CLI::Option* other : given)
        if (option->get_excludes().contains(const_cast<CLI::Option*>(other)))
          failHere("{} and {} exclude each other: keep one of them", quoted(section, key),
                   quoted(sceneSection(*other), sceneKey(*other)));
      given.push_back(option);
    }
}

/// Formats objects of two levels and lists of objects over several lines, other values on one line.
std::string layOut(const OrderedJson& value, int depth = 0) {
  const bool list = value.is_array() && !value.empty() && value.front().is_object();
  if (!list && (!value.is_object() || depth > 1))
    return value.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  const std::string indent(std::size_t(2 * depth + 2), ' ');
  std::vector<std::string> lines;
  for (const auto& [key, entry] : value.items())
    lines.push_back(indent + (list ? "" : inQuotes(key) + ": ") + layOut(entry, depth + 1));
  return fmt::format("{}\n{}\n{}{}", list ? "[" : "{", fmt::join(lines, ",\n"), indent.substr(2),
                     list ? "]" : "}");
}

}  // namespace

void SceneFileOptions::add(CLI::App& app) {
  command_ = &app;
  addText(app, "--scene", "FILE.json", file,
          "Read options that are not given from a scene file (see apps/scenes/README.md)")
      ->group("Scene");
}

void SceneFileOptions::addSave(CLI::App& app) {
  addText(app, "--save-scene", "FILE.json", saved, "Writes a scene of the options as they were resolved")
      ->group("Scene");
}

bool SceneFileOptions::hasVolume() const {
  return file && SceneReader(*command_, *file).hasVolume();
}

void SceneFileOptions::leaveOut(const std::string& option) const {
  command_->get_option(option)->clear();
}

void SceneFileOptions::apply(const std::function<bool(const std::string&)>& wanted) const {
  if (file) SceneReader(*command_, *file).apply(wanted);
}

void SceneFileOptions::save(const OptionList& options) const {
  const fs::path folder = fs::absolute(*saved).parent_path();
  OrderedJson scene;
  for (const auto& [name, text] : options) {
    const CLI::Option* const option = command_->get_option(name.empty() ? "IN" : name);
    OrderedJson& place = scene[sceneSection(*option)][sceneKey(*option)];
    const OrderedJson value = name.starts_with("--no-") ? Json(false) : sceneValue(*option, text, folder);
    if (isRepeated(*option))
      place.push_back(value);
    else
      place = value;
  }
  const DeferredInterrupts wholeFile;
  writeTextAtomically(*saved, layOut(scene) + "\n");
}

}  // namespace freevoxels
