#pragma once
// Scene files: options of the command line as JSON, by group and name (apps/scenes/README.md). Every option
// of a group that shapes the picture is a key, without being named here.

#include <functional>
#include <optional>
#include <string>

#include "apps/freevoxels/option_values.h"

namespace freevoxels {

struct SceneFileOptions {
  std::optional<std::string> file, saved;

  /// --scene.
  void add(CLI::App& app);
  /// --save-scene, of commands that draw.
  void addSave(CLI::App& app);
  /// Whether the scene names a volume.
  bool hasVolume() const;
  /// As if the command line had not given the option.
  void leaveOut(const std::string& option) const;
  /// Gives every option of the command that the command line leaves out, and that `wanted` says yes to, its
  /// value in the scene. What the command line gives takes the place of what it excludes, too. Keys of other
  /// commands alone are passed over. Whatever is wrong with the file: ExitCode::Input.
  void apply(const std::function<bool(const std::string& option)>& wanted) const;
  /// Writes the options that belong into a scene, file names relative to the folder of it.
  void save(const OptionList& options) const;

 private:
  CLI::App* command_ = nullptr;
};

}  // namespace freevoxels
