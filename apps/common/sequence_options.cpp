#include "apps/common/sequence_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "apps/common/frame_names.h"
#include "apps/common/sequence.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

/// Whether a word behind IN is another volume. What is neither a volume nor an image is left to be refused as an image.
bool isVolume(const std::string& word) {
  std::error_code unreadable;
  return !isImage(word) && (proceduralName(word) || word.ends_with(".vdb") || hasScanEnding(word) || isPattern(word) ||
                            fs::is_regular_file(word, unreadable));
}

/// Takes the volumes out of OUT.
std::vector<std::string> takeVolumes(std::vector<std::string>& outputs) {
  const auto images = std::stable_partition(outputs.begin(), outputs.end(), isVolume);
  std::vector<std::string> volumes(outputs.begin(), images);
  outputs.erase(outputs.begin(), images);
  return volumes;
}

std::vector<std::string> extensionsOf(const std::string& formats) {
  std::vector<std::string> extensions;
  for (std::size_t begin = 0; begin <= formats.size();) {
    const std::size_t end = std::min(formats.find(',', begin), formats.size());
    extensions.push_back("." + formats.substr(begin, end - begin));
    if (!isImage("image" + extensions.back()))
      fail(ErrorKind::Usage, "--format takes exr, png and jpg, with commas between them, not '{}'", formats);
    begin = end + 1;
  }
  return extensions;
}

}  // namespace

void SequenceOptions::add(CLI::App& app, std::optional<bool>& fixedView) {
  constexpr const char* kGroup = "Sequence";
  addText(app, "--frames", "A-B:STEP", frames, "Numbers of the frames of IN with a run of #; A-B, A- and A will do [all]")->group(kGroup);
  addText(app, "--out-dir", "FOLDER", folder, "Where images go whose names have no folder; it is made where it is missing")->group(kGroup);
  addText(app, "--format", "LIST", formats, "Of images that have the names of their volumes: exr, png, jpg, with commas between them [png]")
      ->group(kGroup);
  app.add_flag_function(
         "--fixed-view,!--no-fixed-view", [&fixedView](std::int64_t count) { fixedView = count > 0; },
         "Whether the camera, the lights and the scales that the first frame has by default hold for all frames; no: each frame "
         "has its own [they are chosen for the whole film]")
      ->group(kGroup);
}

std::vector<FrameJob> SequenceOptions::plan(SceneOptions& scene) const {
  std::vector<std::string> inputs = takeVolumes(scene.files);
  const bool namesAreOfVolumes = scene.files.empty() && !(isImage(scene.description.input.volume) && scene.sceneHasVolume());
  if (formats && !namesAreOfVolumes) fail(ErrorKind::Usage, "--format is for images without a name: leave it or OUT out");
  const std::vector<std::string> extensions = extensionsOf(formats.value_or("png"));
  scene.takeScene(extensions.front());
  inputs.insert(inputs.begin(), scene.description.input.volume);

  const NumberedVolumes found = findVolumes(inputs, frames);
  for (const std::string& gap : found.gaps) spdlog::warn("{}", gap);

  const auto placed = [&](const std::string& file) {
    return folder && !fs::path(file).has_parent_path() ? (fs::path(*folder) / file).string() : file;
  };
  std::vector<FrameJob> plan;
  for (const NumberedVolume& volume : found.volumes) {
    FrameJob& frame =
        plan.emplace_back(FrameJob{.input = volume.file, .files = {}, .holdout = holdoutOf(scene.description.camera, volume.number)});
    if (namesAreOfVolumes)
      for (const std::string& extension : extensions) frame.files.push_back(placed(volume.name + extension));
    else
      for (const std::string& file : scene.files)
        frame.files.push_back(placed(found.haveNumbers || found.volumes.size() > 1 ? frameName(file, volume.number) : file));
  }
  if (folder) {
    std::error_code seenWhenWriting;
    fs::create_directories(*folder, seenWhenWriting);
  }
  return plan;
}

}  // namespace freevoxels
