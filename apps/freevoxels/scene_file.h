#pragma once
// Scene files: options of the command line as JSON, by group and name (apps/scenes/README.md). Every option
// of a group that affects images is a key, without being listed here.

#include <functional>
#include <optional>
#include <string>

#include "apps/freevoxels/option_values.h"

namespace freevoxels {

struct SceneFileOptions {
  std::optional<std::string> file, saved;

  /// Adds --scene.
  void add(CLI::App& app);
  /// Adds --save-scene, for commands that draw.
  void addSave(CLI::App& app);
  /// Whether the scene names a volume.
  bool hasVolume() const;
  /// Treats an option as not given on the command line.
  void leaveOut(const std::string& option) const;
  /// Sets every option that the command line leaves out, and for which `wanted` is true, to its value in the
  /// scene. Options of the command line also override what they exclude. Keys that only other commands have
  /// are ignored. Fails with ErrorKind::Input for errors in the file.
  void apply(const std::function<bool(const std::string& option)>& wanted) const;
  /// Writes the options that belong into a scene, with file names relative to its folder.
  void save(const OptionList& options) const;

 private:
  CLI::App* command_ = nullptr;
};

}  // namespace freevoxels
