#pragma once
// What every command that makes pictures of a volume is told: the volume, what it is made of, from where it
// is seen, and where the pictures go.

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
  /// Those of them that say how a volume looks.
  void addLook(CLI::App& app);
  /// What --scene has and the command line has not. A single picture is then OUT, where the scene has the
  /// volume. Without OUT it is the volume's name, else the scene's, with `defaultEnding` in place of its extension, in the
  /// current folder; where that is empty OUT is required. To be called before all below.
  void takeScene(const std::string& defaultEnding = ".png");
  /// Options that are wrong with any volume and any file: ExitCode::Usage.
  void checkLook() const;
  /// Before any work; `moreOutputs` are the files that the command writes besides images, `moreInputs` the volumes that it reads
  /// besides IN.
  void check(const std::vector<std::string>& moreOutputs = {}, const std::vector<std::string>& moreInputs = {}) const;
  /// The same scene with other files to write.
  SceneOptions withOutputs(std::vector<std::string> files) const;
  /// Reads the volume, with the grids that the options need; of a baked one an octree level, which other volumes do not have.
  Volume readVolume(std::uint64_t maximumVoxels, int level = 0) const;
  /// The level of a baked volume that frames with this level of detail (FrameSettings::lod) need: one finer than the finest of which
  /// anything is drawn. 0 of other volumes, and where the levels are of scalars that are classified by a transfer function.
  int finestLevelNeeded(double lod, int frames) const;
  /// As CameraOptions::resolve; a baked volume's content is read from its file, so that it does not depend on the level.
  std::vector<Camera> cameras(const Volume& volume, const Classification& classification, int frames = 1) const;
  /// Reads what else there is to read.
  Scene resolve(std::shared_ptr<const Volume> volume) const;
  /// The two halves of it: how a volume is classified, and how it is seen and lit, `scene` having the other half.
  Classification resolveClassification(const Volume& volume) const;
  void resolveView(Scene& scene) const;
  /// Both.
  Scene open(std::uint64_t maximumVoxels, int level = 0) const;
  /// As `resolve`, but with the camera, the lights and the scales of densities and temperatures or the transfer function of
  /// another volume's scene, so that frames of one film fit together.
  Scene resolveLike(const Scene& other, std::shared_ptr<const Volume> volume) const;
  /// Everything that a Renderer of the scene depends on, beside its volume: scenes of equal text share one.
  std::string rendererText(const Scene& scene, const TableSettings& table) const;
  /// One warning each for values of the scene's volume that are not drawn as they are.
  void warn(const Scene& scene) const;
  /// Writes --save-scene, where it is wanted.
  void save(const OptionList& options) const;
  /// Everything resolved, with the options of the command's own between those of the camera and the outputs.
  OptionList describe(const Scene& scene, const OptionList& method = {}) const;
  /// The header of an .exr. `command` and `facts` as for exrMetadata, which the volume's source joins.
  ExrOptions header(const Scene& scene, const std::string& command, const OptionList& options,
                    std::map<std::string, std::string> facts) const;
  /// Writes a whole image of the scene, with such a header.
  void write(Image image, const Scene& scene, const std::string& command, const OptionList& options,
             std::map<std::string, std::string> facts) const;
};

}  // namespace freevoxels
