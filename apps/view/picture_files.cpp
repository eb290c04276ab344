#include "apps/view/picture_files.h"

#include <CLI/CLI.hpp>

#include "apps/freevoxels/background_writer.h"
#include "apps/freevoxels/frame_names.h"
#include "apps/freevoxels/render_options.h"

namespace freevoxels {

namespace {

/// The options of the picture that count where it is written to these files.
SceneOptions sceneInto(const Picture& picture, std::vector<std::string> files) {
  SceneOptions scene = picture.request.scene.withOutputs(std::move(files));
  scene.output.leaveOutUnhonoured();
  return scene;
}

OptionList optionsOf(const SceneOptions& scene, const Picture& picture) {
  OptionList method;
  picture.request.method.describe(method);
  return scene.describe(picture.scene, method);
}

std::vector<std::string> filesOfTurn(const std::string& pattern, int frames) {
  std::vector<std::string> files;
  for (int frame = 0; frame < frames; ++frame) files.push_back(frameName(pattern, frame));
  return files;
}

}  // namespace

std::string commandOf(const Picture& picture, const std::string& file) {
  return commandInto("render", optionsOf(sceneInto(picture, {file}), picture), file);
}

std::string turnCommandOf(const Picture& picture, const std::string& pattern, int frames) {
  const SceneOptions scene = sceneInto(picture, {pattern});
  OptionList options = optionsOf(scene, picture);
  scene.camera.describeTurn(options);
  options.emplace_back("--frames", fmt::format("{}", frames));
  return commandInto("turntable", options, pattern);
}

void savePicture(const Device& device, const Picture& picture, const std::string& file) {
  const SceneOptions scene = sceneInto(picture, {file});
  scene.check();
  scene.write(downloadImage(device, *picture.image), picture.scene, "render", optionsOf(scene, picture),
              {{"device", picture.device.name}, {"driver", picture.device.driver}});
}

void saveScene(const Picture& picture, const std::string& file) {
  sceneInto(picture, {}).check({file});
  CLI::App command;
  RenderOptions render;
  render.add(command);  // whose options are the keys
  render.scene.file.saved = file;
  render.scene.save(picture.options);
}

void saveTurn(const Device& device, const Picture& picture, const std::string& pattern, int frames,
              const Progress& progress) {
  const std::vector<std::string> files = filesOfTurn(pattern, frames);
  PictureRequest request = picture.request;
  request.scene = sceneInto(picture, files);
  request.scene.check();
  const std::vector<Camera> cameras =
      request.scene.cameras(*picture.scene.volume, picture.scene.classification, frames);

  VolumeCache volumes(request.scene, picture.scene.volume);
  PictureMaker maker(device, volumes);
  BackgroundWriter writer;
  for (int frame = 0; frame < frames; ++frame) {
    const double start = double(frame) / frames;
    const Progress ofFrame = [&](std::string_view stage, double fraction) {
      progress(fmt::format("frame {} of {}: {}", frame + 1, frames, stage), start + fraction / frames);
    };
    request.scene.camera.look(cameras[std::size_t(frame)]);
    writer.start([&device, picture = maker.make(request, ofFrame), &file = files[std::size_t(frame)]] {
      savePicture(device, picture, file);
    });
  }
  writer.finish();
}

}  // namespace freevoxels
