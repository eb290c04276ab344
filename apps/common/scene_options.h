#pragma once
// The options of all commands that draw a volume: they give the fields of a scene description, in the order defaults, --scene,
// options of the command line.

#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/common/background_writer.h"
#include "apps/common/option_values.h"
#include "apps/common/output_options.h"
#include "engine/description/scene_fields.h"

namespace freevoxels {

/// The fields that the description gives, and for which `wanted` is true, as options.
OptionList optionsOf(const SceneDescription& description, const std::function<bool(const SceneField&)>& wanted = {});

struct SceneOptions {
  SceneDescription description;
  std::vector<std::string> files;          ///< the images to write: OUT
  std::optional<std::string> file, saved;  ///< --scene and --save-scene

  /// Adds IN, OUT, --scene, --save-scene and the options of all sections but "method", without those that addMethod() adds.
  void add(CLI::App& app);
  /// Adds the options of the drawing method, and those of light that the oracle does not have.
  void addMethod(CLI::App& app);
  /// Adds OUT.
  void addOut(CLI::App& app);
  /// Adds --scene.
  void addFile(CLI::App& app);
  /// Adds the options of a section of scene files, without those that only some commands have.
  void addSection(CLI::App& app, std::string_view section);
  /// Adds options by the names of their fields. Fields that were never added are ignored in scene files.
  void addFields(CLI::App& app, std::initializer_list<std::string_view> names);
  /// Adds the option of a field with a --help text of its own.
  CLI::Option* addField(CLI::App& app, std::string_view name, const std::string& help);

  /// Whether --scene names a volume.
  bool sceneHasVolume() const;
  /// Applies --scene to the fields that the command line leaves open, without those that none of `files` honours. Fails with
  /// ErrorKind::Input for errors in the file.
  void applyScene();
  /// Applies --scene. A single image argument is then OUT, if the scene has the volume. Without OUT it is the name of the volume, or
  /// else of the scene, with `defaultEnding` instead of the extension, in the current folder; if `defaultEnding` is empty, OUT is
  /// required. Must be called before the functions below.
  void takeScene(const std::string& defaultEnding = ".png");
  /// Checks everything before any work. `images` are the files to write, `moreOutputs` those that the command writes in addition to
  /// images, `moreInputs` the volumes that it reads in addition to IN.
  void check(std::span<const std::string> images, const std::vector<std::string>& moreOutputs = {},
             const std::vector<std::string>& moreInputs = {}) const;
  /// The fields of a description for which this command has options.
  OptionList ownOptions(const SceneDescription& whole) const;
  /// Writes these fields into the file of --save-scene, if it is given.
  void save(const SceneDescription& resolved) const;

 private:
  std::map<const SceneField*, CLI::Option*> options_;
};

/// The same of a description that comes without options.
void checkScene(const SceneDescription& description, std::span<const std::string> images, std::vector<std::string> moreOutputs = {},
                const std::vector<std::string>& moreInputs = {});

/// Logs what the user should know of a volume (warningsOf).
void logWarnings(const Volume& volume, bool scalarsAreDensities);
/// Logs what was assumed of a volume (remarksOf).
void logAssumptions(const Volume& volume);
/// Logs values of the volume that are not drawn as they are, and what was chosen for it.
void logRemarks(const SceneDescription& description, const Scene& scene);

/// The header of an .exr. `command` and `facts` as for exrMetadata, which the volume's source joins.
ExrOptions imageHeader(const SceneDescription& description, const Scene& scene, const std::string& command, const OptionList& options,
                       std::map<std::string, std::string> facts);
/// What writes a whole image of the scene, with such a header. It keeps nothing of the scene.
WritingTask imageWriting(Image image, const SceneDescription& description, std::span<const std::string> files, const Scene& scene,
                         const std::string& command, const OptionList& options, std::map<std::string, std::string> facts);
/// Writes such an image.
void writeImages(Image image, const SceneDescription& description, std::span<const std::string> files, const Scene& scene,
                 const std::string& command, const OptionList& options, std::map<std::string, std::string> facts);

}  // namespace freevoxels
