#pragma once
// The options of all commands that draw a volume: the volume, its classification, camera and light, and the
// outputs.

#include <memory>

#include "apps/freevoxels/camera_options.h"
#include "apps/freevoxels/classification_options.h"
#include "apps/freevoxels/emission_options.h"
#include "apps/freevoxels/input_options.h"
#include "apps/freevoxels/lighting_options.h"
#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/output_options.h"
#include "apps/freevoxels/scene_file.h"

namespace freevoxels {

struct Scene {
  std::shared_ptr<const Volume> volume;
  Classification classification;
  Camera camera;
  std::optional<Lighting> lighting;
};

struct SceneOptions {
  InputOptions input;
  OutputOptions output;
  ClassificationOptions classification;
  EmissionOptions emission;
  CameraOptions camera;
  LightingOptions lighting;
  SceneFileOptions file;

  void add(CLI::App& app);
  /// Adds the options that determine how a volume looks.
  void addLook(CLI::App& app);
  /// Applies --scene. A single image argument is then OUT, if the scene has the volume. Without OUT it is the
  /// name of the volume, or else of the scene, with `defaultEnding` instead of the extension, in the current
  /// folder; if `defaultEnding` is empty, OUT is required. Must be called before all functions below.
  void takeScene(const std::string& defaultEnding = ".png");
  /// Fails with ErrorKind::Usage for options that are wrong for every volume and file.
  void checkLook() const;
  /// Checks all options before any work. `moreOutputs` are files that the command writes in addition to
  /// images, `moreInputs` the volumes that it reads in addition to IN.
  void check(const std::vector<std::string>& moreOutputs = {}, const std::vector<std::string>& moreInputs = {}) const;
  /// A copy with other files to write.
  SceneOptions withOutputs(std::vector<std::string> files) const;
  /// Reads the volume, with the grids that the options need; of a baked one an octree level, which other volumes do not have.
  Volume readVolume(std::uint64_t maximumVoxels, int level = 0) const;
  /// The level of a baked volume that frames with this level of detail (FrameSettings::lod) need: one finer than the finest of which
  /// anything is drawn. 0 of other volumes, and where the levels are of scalars that are classified by a transfer function.
  int finestLevelNeeded(double lod, int frames) const;
  /// Whether what is seen of a baked volume is what its file says, as its classification is the baked one or differs in density alone.
  bool isAsBaked(const Volume& volume, const Classification& classification) const;
  /// As CameraOptions::resolve; a baked volume's content is read from its file, so that it does not depend on the level.
  std::vector<Camera> cameras(const Volume& volume, const Classification& classification, int frames = 1) const;
  /// Reads the other files and resolves the scene.
  Scene resolve(std::shared_ptr<const Volume> volume) const;
  /// The two parts of resolve(): classification, and camera and light. `scene` must have the other part.
  Classification resolveClassification(const Volume& volume) const;
  void resolveView(Scene& scene) const;
  /// Reads the volume and resolves the scene.
  Scene open(std::uint64_t maximumVoxels, int level = 0) const;
  /// As `resolve`, but with the camera, the lights and the scales of densities and temperatures or the transfer function of
  /// another volume's scene, so that frames of one film fit together.
  Scene resolveLike(const Scene& other, std::shared_ptr<const Volume> volume) const;
  /// A text of everything that a Renderer of the scene depends on, except for its volume: scenes with equal
  /// text can share one.
  std::string rendererText(const Scene& scene, const TableSettings& table) const;
  /// Warns of values of the volume that are not drawn as they are.
  void warn(const Scene& scene) const;
  /// Writes the file of --save-scene, if it is given.
  void save(const OptionList& options) const;
  /// All resolved options, with the command's own options between those of the camera and the outputs.
  OptionList describe(const Scene& scene, const OptionList& method = {}) const;
  /// The header of an .exr. `command` and `facts` as for exrMetadata, which the volume's source joins.
  ExrOptions header(const Scene& scene, const std::string& command, const OptionList& options,
                    std::map<std::string, std::string> facts) const;
  /// Writes a whole image of the scene, with such a header.
  void write(Image image, const Scene& scene, const std::string& command, const OptionList& options,
             std::map<std::string, std::string> facts) const;
};

}  // namespace freevoxels
