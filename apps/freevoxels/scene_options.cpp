#include "apps/freevoxels/scene_options.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "apps/freevoxels/program.h"
#include "engine/core/error.h"
#include "engine/storage/baked_volume.h"
#include "engine/visibility/detail_rule.h"
#include "engine/volume/emission_light.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

/// The light that the volume's own emission throws on it, where it is lit.
void makeEmissionLight(Scene& scene) {
  scene.classification.emissionLight = nullptr;
  if (scene.classification.emission && scene.lighting)
    scene.classification.emissionLight = std::make_shared<const EmissionLight>(*scene.volume, scene.classification);
}

}  // namespace

void SceneOptions::add(CLI::App& app) {
  input.add(app);
  input.addGrid(app);
  input.addClip(app);
  output.add(app);
  addLook(app);
  file.addSave(app);
}

void SceneOptions::addLook(CLI::App& app) {
  classification.add(app);
  emission.add(app);
  camera.add(app);
  lighting.add(app);
  file.add(app);
}

void SceneOptions::takeScene(const std::string& defaultEnding) {
  if (isImage(input.input) && file.hasVolume()) {
    output.files.insert(output.files.begin(), input.input);
    input.input.clear();
    file.leaveOut("IN");
  } else if (isImage(input.input)) {
    fail(ErrorKind::Usage, "IN is required: '{}' is an image, which OUT is; name an OpenVDB file before it, or procedural:NAME",
         input.input);
  }
  if (output.files.empty() && !defaultEnding.empty()) {
    const std::string& named = !input.input.empty() || !file.file ? input.input : *file.file;
    output.files = {proceduralName(named).value_or(std::filesystem::path(named).stem().string()) + defaultEnding};
  }
  file.apply([this](const std::string& option) { return output.honours(option); });
  input.checkGiven();
  if (output.files.empty()) fail(ErrorKind::Usage, "OUT is required: name an image to write, .exr, .png or .jpg");
}

void SceneOptions::checkLook() const {
  input.check();
  if (classification.albedoGrid && proceduralName(input.input))
    fail(ErrorKind::Usage, "--albedo-grid chooses among the grids of a file, and {} has one", input.input);
  emission.check(input);
  camera.check();
  lighting.check();
}

void SceneOptions::check(const std::vector<std::string>& moreOutputs, const std::vector<std::string>& moreInputs) const {
  checkLook();
  output.check();
  output.checkCrop(camera.size);
  std::vector<std::string> files = moreOutputs;
  if (file.saved) files.push_back(*file.saved);
  for (const std::string& written : files) checkOutput(written);
  files.insert(files.end(), output.files.begin(), output.files.end());
  std::vector<std::string> volumes = moreInputs;
  volumes.push_back(input.input);
  for (const std::string& volume : volumes)
    if (!proceduralName(volume)) files.push_back(volume);
  for (const std::optional<std::string>& read : {file.file, lighting.environment})
    if (read) files.push_back(*read);
  checkDistinct(files);
}

SceneOptions SceneOptions::withOutputs(std::vector<std::string> files) const {
  SceneOptions options = *this;
  options.output.files = std::move(files);
  return options;
}

Volume SceneOptions::readVolume(std::uint64_t maximumVoxels, int level) const {
  return input.open(maximumVoxels, {.temperature = emission.grid(), .albedo = classification.albedoGrid}, level);
}

int SceneOptions::finestLevelNeeded(double lod, int frames) const {
  const std::shared_ptr<const fvx::FvxFile> baked = input.baked();
  if (!baked) return 0;
  const Volume outline = bakedOutline(*baked);
  const Classification classified = resolveClassification(outline);
  if (classified.transferFunction) return 0;
  const HierarchyLayout hierarchy(outline.dimensions);
  int level = baked->levels() - 1;
  for (const Camera& one : cameras(outline, classified, frames))
    level = std::min(level, detailRule(hierarchy, pixelRays(one, camera.size, outline.indexToWorld), camera.size, lod).finest);
  // One level finer than what is drawn, as the footprints of what is drawn are those of the opened level's voxels.
  return std::max(level - 1, 0);
}

bool SceneOptions::isAsBaked(const Volume& volume, const Classification& classified) const {
  // Another density scale leaves the content as it is; a transfer function does not.
  return volume.classification &&
         (volume.classificationIsFixed || (!classified.transferFunction && !volume.classification->transferFunction));
}

std::vector<Camera> SceneOptions::cameras(const Volume& volume, const Classification& classified, int frames) const {
  const auto content = [&] {
    if (!isAsBaked(volume, classified)) return contentOf(volume, classified);
    const std::shared_ptr<const fvx::FvxFile> baked = input.baked();
    return subjectOf(baked->content(), baked->description().volume);
  };
  return camera.resolve(volume.up, content, frames);
}

Scene SceneOptions::resolve(std::shared_ptr<const Volume> volume) const {
  Scene scene{.volume = std::move(volume)};
  scene.classification = resolveClassification(*scene.volume);
  resolveView(scene);
  return scene;
}

Classification SceneOptions::resolveClassification(const Volume& volume) const {
  Classification result = classification.resolve(volume, emission.grid().has_value());
  result.emission = emission.resolve(volume, result);
  if (result.emission && !classification.albedo && !volume.classification) result.albedo = glm::vec3(kSmokeAlbedo);
  return result;
}

void SceneOptions::resolveView(Scene& scene) const {
  scene.camera = cameras(*scene.volume, scene.classification).front();
  scene.lighting = lighting.resolve(*scene.volume, scene.classification, scene.camera);
  makeEmissionLight(scene);
}

Scene SceneOptions::resolveLike(const Scene& other, std::shared_ptr<const Volume> volume) const {
  SceneOptions fixed = *this;
  if (!volume->classificationIsFixed) fixed.classification.take(other.classification);
  if (other.classification.emission) fixed.emission.take(*other.classification.emission);
  Scene scene{.volume = std::move(volume), .camera = other.camera, .lighting = other.lighting};
  scene.classification = fixed.resolveClassification(*scene.volume);
  makeEmissionLight(scene);
  return scene;
}

Scene SceneOptions::open(std::uint64_t maximumVoxels, int level) const {
  return resolve(std::make_shared<const Volume>(readVolume(maximumVoxels, level)));
}

std::string SceneOptions::rendererText(const Scene& scene, const TableSettings& table) const {
  OptionList options;
  classification.describe(options, *scene.volume, scene.classification);
  emission.describe(options, *scene.volume, scene.classification.emission);
  options.emplace_back("table", tableText(table));
  // Blocks store the scattered light of the emission together with the emission.
  options.emplace_back("emission light", scene.classification.emissionLight ? "yes" : "no");
  return commandText(options);
}

void SceneOptions::warn(const Scene& scene) const {
  logWarnings(*scene.volume, !scene.classification.transferFunction);
  if (scene.classification.transferFunction && !classification.transferFunction && !scene.volume->classification)
    spdlog::info("{} looks like a scan: the transfer function is made from its histogram; change it with --transfer-function, or "
                 "show densities with --density-scale",
                 scene.volume->source);
  if (!camera.up && !camera.position && !scene.volume->upReason.empty())
    spdlog::info("up is {}, as {}; change it with --up", numberText(scene.volume->up), scene.volume->upReason);
  if (scene.lighting && scene.lighting->environment && scene.lighting->environment->negativeValues > 0)
    spdlog::warn("values of '{}' below 0 count as 0: {} of them", *lighting.environment, scene.lighting->environment->negativeValues);
  EmissionOptions::warn(*scene.volume, scene.classification);
}

void SceneOptions::save(const OptionList& options) const {
  if (file.saved) file.save(options);
}

OptionList SceneOptions::describe(const Scene& scene, const OptionList& method) const {
  OptionList options;
  input.describe(options);
  classification.describe(options, *scene.volume, scene.classification);
  emission.describe(options, *scene.volume, scene.classification.emission);
  camera.describe(options, scene.camera);
  lighting.describe(options, scene.lighting);
  options.insert(options.end(), method.begin(), method.end());
  output.describe(options);
  return options;
}

ExrOptions SceneOptions::header(const Scene& scene, const std::string& command, const OptionList& options,
                                std::map<std::string, std::string> facts) const {
  facts.emplace("volume", scene.volume->source);
  ExrOptions exr = exrMetadata(command, options, facts, scene.camera, double(camera.size.x) / double(camera.size.y));
  exr.fullFloat = output.fullFloat;
  return exr;
}

void SceneOptions::write(Image image, const Scene& scene, const std::string& command, const OptionList& options,
                         std::map<std::string, std::string> facts) const {
  addChannels(image, output.aovs, scene.camera);
  output.write(image, header(scene, command, options, std::move(facts)));
}

}  // namespace freevoxels
