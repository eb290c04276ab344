#include "apps/common/scene_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>

#include "apps/common/annotation.h"
#include "apps/common/failure.h"
#include "apps/common/option_help.h"
#include "apps/common/program.h"
#include "apps/common/sequence.h"
#include "engine/core/error.h"
#include "engine/description/scene_json.h"
#include "engine/description/text_values.h"
#include "engine/volume/blackbody.h"

namespace freevoxels {

namespace {

using Kind = SceneField::Kind;

/// The group of --help that has the options of a section.
std::string groupOf(const std::string& section) {
  return char(std::toupper(section[0])) + section.substr(1);
}

}  // namespace

OptionList optionsOf(const SceneDescription& description, const std::function<bool(const SceneField&)>& wanted) {
  OptionList options;
  for (const SceneField& field : sceneFields()) {
    if (wanted && !wanted(field)) continue;
    for (const std::string& text : field.texts(description)) {
      const bool isFlag = field.kind == Kind::Flag || field.kind == Kind::Switch || (field.standsAlone && text == kNone);
      if (field.kind == Kind::Volume)
        options.emplace_back("", text);
      else
        options.emplace_back((isFlag && text != "true" ? "--no-" : "--") + field.name, isFlag ? "" : text);
    }
  }
  return options;
}

void SceneOptions::add(CLI::App& app) {
  addSection(app, "input");
  addOut(app);
  for (const char* section : {"volumes", "output", "classification", "emission", "camera", "light"}) addSection(app, section);
  addFile(app);
  addText(app, "--save-scene", "FILE.json", saved, "Writes a scene of the options as they were resolved")->group("Scene");
}

void SceneOptions::addOut(CLI::App& app) {
  app.add_option("OUT,-o,--output", files,
                 "Images to write: .exr (linear, premultiplied), .png or .jpg (sRGB) [the volume's name .png, in the current folder]");
}

void SceneOptions::addFile(CLI::App& app) {
  addText(app, "--scene", "FILE.json", file, "Read options that are not given from a scene file (see apps/scenes/README.md)")
      ->group("Scene");
}

void SceneOptions::addSection(CLI::App& app, std::string_view section) {
  for (const OptionHelp& help : optionHelp())
    if (!help.ofMethod && sceneField(help.field).section == section) addField(app, help.field, help.text);
}

void SceneOptions::addMethod(CLI::App& app) {
  for (const OptionHelp& help : optionHelp())
    if (help.ofMethod) addField(app, help.field, help.text);
}

void SceneOptions::addFields(CLI::App& app, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) addField(app, name, std::ranges::find(optionHelp(), name, &OptionHelp::field)->text);
}

CLI::Option* SceneOptions::addField(CLI::App& app, std::string_view name, const std::string& help) {
  const SceneField& field = sceneField(name);
  const auto give = [this, &field](const std::vector<std::string>& texts) { field.read(description, texts); };
  CLI::Option* option = nullptr;
  if (field.kind == Kind::Flag || field.kind == Kind::Switch) {
    const std::string names = field.kind == Kind::Flag ? "--" + field.name : fmt::format("--{0},!--no-{0}", field.name);
    option = app.add_flag_function(
        names, [give](std::int64_t count) { give({count > 0 ? "true" : "false"}); }, help);
  } else if (field.kind == Kind::Volume) {
    option = app.add_option_function<std::string>(
        "IN", [give](const std::string& text) { give({text}); }, help);
  } else if (field.repeated) {
    option = app.add_option_function<std::vector<std::string>>("--" + field.name, give, help)
                 ->allow_extra_args(false)
                 ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
                 ->type_name(field.form);
  } else {
    option = app.add_option_function<std::string>(
                    "--" + field.name, [give](const std::string& text) { give({text}); }, help)
                 ->take_last()
                 ->type_name(field.form);
    if (field.standsAlone) {
      option->expected(0, 1);
      app.add_flag_function(
             "--no-" + field.name, [give](std::int64_t) { give({kNone}); }, "Not that")
          ->excludes(option)
          ->group(groupOf(field.section));
    }
  }
  for (const auto& [other, added] : options_)
    if (other != &field && field.isOrExcludes(*other)) option->excludes(added);
  options_[&field] = option;
  return option->group(groupOf(field.section));
}

bool SceneOptions::sceneHasVolume() const {
  return file && SceneFile(*file).hasVolume();
}

void SceneOptions::applyScene() {
  if (!file) return;
  SceneFieldSet given;
  for (const auto& [field, option] : options_)
    if (option->count() > 0) given.insert(field);
  const SceneFile scene(*file);
  for (const std::string& warning : scene.warnings()) spdlog::warn("{}", warning);
  scene.applyTo(description, [&](const SceneField& field) {
    return options_.contains(&field) && !isReplaced(field, given) && (files.empty() || honours(files, field.name));
  });
}

void SceneOptions::takeScene(const std::string& defaultEnding) {
  std::string& volume = description.input.volume;
  if (isImage(volume) && sceneHasVolume()) {
    files.insert(files.begin(), volume);
    volume.clear();
    options_.at(&sceneField("volume"))->clear();
  } else if (isImage(volume)) {
    fail(ErrorKind::Usage, "IN is required: '{}' is an image, which OUT is; name a volume before it, a file or procedural:NAME", volume);
  }
  if (files.empty() && !defaultEnding.empty()) {
    const std::string& named = !volume.empty() || !file ? volume : *file;
    files = {nameOfVolume(named) + defaultEnding};
  }
  applyScene();
  description.input.checkGiven();
  if (files.empty()) fail(ErrorKind::Usage, "OUT is required: name an image to write, .exr, .png or .jpg");
}

void SceneOptions::check(std::span<const std::string> images, const std::vector<std::string>& moreOutputs,
                         const std::vector<std::string>& moreInputs) const {
  std::vector<std::string> outputs = moreOutputs, read = moreInputs;
  if (saved) outputs.push_back(*saved);
  if (file) read.push_back(*file);
  checkScene(description, images, std::move(outputs), read);
}

OptionList SceneOptions::ownOptions(const SceneDescription& whole) const {
  return optionsOf(whole, [this](const SceneField& field) { return options_.contains(&field); });
}

void SceneOptions::save(const SceneDescription& resolved) const {
  if (!saved) return;
  const DeferredInterrupts wholeFile;
  writeScene(*saved, partOf(resolved, [this](const SceneField& field) { return options_.contains(&field); }));
}

void checkScene(const SceneDescription& description, std::span<const std::string> images, std::vector<std::string> moreOutputs,
                const std::vector<std::string>& moreInputs) {
  description.check();
  checkOutputs(description.output, images);
  description.output.checkCrop(description.camera.size);
  for (const std::string& written : moreOutputs) checkOutput(written);
  std::vector<std::string> files = std::move(moreOutputs);
  std::ranges::copy_if(images, std::back_inserter(files), [](const std::string& image) { return image != kStandardOutput; });
  for (const std::string& volume : moreInputs)
    if (!proceduralName(volume)) files.push_back(volume);
  if (!proceduralName(description.input.volume)) files.push_back(description.input.volume);
  if (description.lighting.environment) files.push_back(*description.lighting.environment);
  if (const auto& flight = description.camera.flight; flight && !isInlineJson(*flight)) files.push_back(*flight);
  checkDistinct(files);
}

void logWarnings(const Volume& volume, bool scalarsAreDensities) {
  for (const std::string& warning : warningsOf(volume, scalarsAreDensities)) spdlog::warn("{}", withOptions(warning));
}

void logAssumptions(const Volume& volume) {
  if (const std::string remarks = remarksOf(volume); !remarks.empty()) spdlog::info("{}", withOptions(remarks));
}

namespace {

/// Warns of temperatures that are not drawn as they are, and if nothing emits light.
void warnOfTemperatures(const Volume& volume, const Classification& classification) {
  if (!classification.emission) return;
  const TemperatureGrid& grid = *volume.temperature;
  if (grid.nanVoxels > 0) {
    const bool one = grid.nanVoxels == 1;
    spdlog::warn("{} temperature{} of {} that {} NaN or infinite {} no data", grid.nanVoxels, one ? "" : "s", volume.source,
                 one ? "is" : "are", one ? "is" : "are");
  }
  if (classification.emission->strength > 0.0 && brightestLight(classification, volume) == 0.0)
    spdlog::warn(
        "no temperature of {} is above {:g} K, so that nothing sends out light; --temperature-scale "
        "and --temperature-grid change that",
        volume.source, kColdestLight);
}

}  // namespace

void logRemarks(const SceneDescription& description, const Scene& scene) {
  const Volume& volume = *scene.volume;
  for (const std::string& warning : functionWarnings(description)) spdlog::warn("{}", warning);
  logWarnings(volume, !scene.classification.transferFunction);
  logAssumptions(volume);
  const ClassificationDescription& given = description.classification;
  const bool isChosen = given.transferFunction || given.window || given.iso || description.method.showsValues();
  if (scene.classification.transferFunction && !isChosen && !volume.classification)
    spdlog::info(
        "{} looks like a scan: the transfer function is made from its histogram; change it with --transfer-function, or "
        "show densities with --density-scale",
        volume.source);
  if (given.transferFunction && !given.window && !description.method.showsValues() &&
      drawsAir(volume, *scene.classification.transferFunction))
    spdlog::warn(
        "the transfer function draws the air around {}, which has other values than it is made for: --window LO..HI moves it over them",
        volume.source);
  if (!description.camera.up && !description.camera.position && !description.camera.flight && !volume.upReason.empty())
    spdlog::info("up is {}, as {}; change it with --up", numberText(volume.up), volume.upReason);
  if (scene.lighting && scene.lighting->environment && scene.lighting->environment->negativeValues > 0)
    spdlog::warn("values of '{}' below 0 count as 0: {} of them", *description.lighting.environment,
                 scene.lighting->environment->negativeValues);
  warnOfTemperatures(volume, scene.classification);
  if (description.method.annotate && !canAnnotate(description, scene))
    spdlog::warn(
        "--annotate has nothing to draw: {} is shown without a transfer function, and lengths are exact only with --orthographic and "
        "--slice",
        volume.source);
}

ExrOptions imageHeader(const SceneDescription& description, const Scene& scene, const std::string& command, const OptionList& options,
                       std::map<std::string, std::string> facts) {
  facts.emplace("volume", scene.volume->source);
  const glm::dvec2 size(description.camera.size);
  ExrOptions exr = exrMetadata(command, options, facts, scene.camera, size.x / size.y);
  exr.fullFloat = description.output.fullFloat;
  return exr;
}

WritingTask imageWriting(Image image, const SceneDescription& description, std::span<const std::string> files, const Scene& scene,
                         const std::string& command, const OptionList& options, std::map<std::string, std::string> facts) {
  addChannels(image, description.output.aovs, scene.camera);
  annotate(image, description, scene);
  return {.bytes = bytesOf(image),
          .write = [image = std::move(image), output = description.output, names = std::vector<std::string>(files.begin(), files.end()),
                    header = imageHeader(description, scene, command, options, std::move(facts))] {
            writeImages(image, output, names, header);
          }};
}

void writeImages(Image image, const SceneDescription& description, std::span<const std::string> files, const Scene& scene,
                 const std::string& command, const OptionList& options, std::map<std::string, std::string> facts) {
  imageWriting(std::move(image), description, files, scene, command, options, std::move(facts)).write();
}

}  // namespace freevoxels
