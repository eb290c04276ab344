#include "apps/view/export_files.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <span>
#include <sstream>
#include <vector>

#include "apps/common/annotation.h"
#include "apps/common/background_writer.h"
#include "apps/common/frame_names.h"
#include "apps/common/program.h"
#include "apps/common/scene_options.h"
#include "apps/view/view_state.h"
#include "engine/core/error.h"
#include "engine/description/scene_json.h"
#include "engine/octree/volume_limits.h"

namespace freevoxels {

namespace {

constexpr std::string_view kBreak = " \\\n";  // which a shell passes over
constexpr std::size_t kBreakColumns = 2;

/// Split at blanks outside of single quotes.
std::vector<std::string_view> wordsOf(std::string_view command) {
  std::vector<std::string_view> words;
  bool quoted = false;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= command.size(); ++i) {
    if (i == command.size() || (command[i] == ' ' && !quoted)) {
      if (i > first) words.push_back(command.substr(first, i - first));
      first = i + 1;
    } else if (command[i] == '\'') {
      quoted = !quoted;
    } else if (command[i] == '\\' && !quoted) {
      ++i;  // what follows stands for itself
    }
  }
  return words;
}

/// A word that is longer than a line, where nothing in it keeps a shell from joining it again.
std::string inPieces(std::string_view word, std::size_t columns) {
  std::string pieces;
  const bool plain = word.find_first_of("'\"\\") == std::string_view::npos;
  for (; plain && columns > 1 && word.size() > columns; word.remove_prefix(columns - 1)) {
    pieces += word.substr(0, columns - 1);
    pieces += "\\\n";
  }
  return pieces.append(word);
}

/// The scene of the image, with what counts where it is written to these files.
SceneDescription sceneInto(const DrawnImage& drawn, std::span<const std::string> files) {
  SceneDescription scene = drawn.request.scene;
  scene.output = honoured(scene.output, files);
  return scene;
}

std::vector<std::string> filesOfTurn(const std::string& pattern, int frames) {
  std::vector<std::string> files;
  for (int frame = 0; frame < frames; ++frame) files.push_back(frameName(pattern, frame));
  return files;
}

/// The command that reads an image from its standard input into the clipboard.
std::vector<std::string> clipboardCommand() {
  if (std::getenv("WAYLAND_DISPLAY") != nullptr) return {"wl-copy", "--type", "image/png"};
  return {"xclip", "-selection", "clipboard", "-target", "image/png", "-in"};
}

/// Empty if it is not installed.
std::string programPath(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/" + name).c_str(), X_OK) == 0) return folder + "/" + name;
  return "";
}

/// A file without a name that has these bytes.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::span<const std::uint8_t> bytes) : file_(std::tmpfile()) {
    if (file_ == nullptr || std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size() || std::fflush(file_) != 0)
      fail(ErrorKind::Output, "cannot write a temporary file for the clipboard: make room in '{}'",
           std::filesystem::temp_directory_path().string());
    std::rewind(file_);
  }
  ~TemporaryFile() {
    if (file_ != nullptr) std::fclose(file_);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  int descriptor() const { return fileno(file_); }

 private:
  std::FILE* file_;
};

}  // namespace

std::string wrappedCommand(std::string_view command, std::size_t columns) {
  std::string text;
  std::size_t used = 0;
  for (const std::string_view word : wordsOf(command)) {
    const bool fits = used + 1 + word.size() + kBreakColumns <= columns;
    if (used > 0) text += fits ? " " : kBreak;
    const std::string pieces = used > 0 && fits ? std::string(word) : inPieces(word, columns);
    used = used > 0 && fits ? used + 1 + word.size() : pieces.size() - (pieces.rfind('\n') + 1);
    text += pieces;
  }
  return text;
}

std::string commandOf(const DrawnImage& drawn, const std::string& file) {
  return commandInto("render", optionsOf(sceneInto(drawn, {&file, 1}).resolved(drawn.scene)), file);
}

std::string commandOf(const DrawnImage& drawn, const MovedFrames& moved) {
  SceneDescription scene = sceneInto(drawn, {&moved.pattern, 1});
  scene.camera.flight = moved.flight;
  return commandInto("turntable", optionsOf(scene.resolvedTurn(drawn.scene, moved.frames)), moved.pattern);
}

namespace {

/// What writes an image of this device, with all that `freevoxels render` would write. It keeps nothing of the device and the scene.
WritingTask writingOf(const Device& device, const DrawnImage& drawn, const std::string& file) {
  const std::span<const std::string> files(&file, 1);
  const SceneDescription scene = sceneInto(drawn, files);
  checkScene(scene, files);
  if (scene.output.aovs.hasLayers())
    fail(ErrorKind::Usage,
         "the image of a window has no layers, which are drawn one by one: copy the command that renders it, and run that");
  return imageWriting(downloadImage(device, *drawn.image), scene, files, drawn.scene, "render", optionsOf(scene.resolved(drawn.scene)),
                      {{"device", drawn.device.name}, {"driver", drawn.device.driver}});
}

}  // namespace

void saveImage(const Device& device, const DrawnImage& drawn, const std::string& file) {
  writingOf(device, drawn, file).write();
}

void saveImageOfSize(const Device& device, const DrawnImage& drawn, glm::ivec2 size, const std::string& file, const Progress& progress) {
  ImageRequest request = drawn.request;
  request.scene = sceneInto(drawn, {&file, 1});
  request.scene.camera.size = size;
  request.scene.camera.look(drawn.scene.camera);  // what is automatic would depend on the image's shape
  checkScene(request.scene, {&file, 1});
  VolumeCache volumes(request.scene, drawn.scene.volume);
  saveImage(device, ImageMaker(device, volumes).make(request, progress), file);
}

bool canCopyImages() {
  return !programPath(clipboardCommand().front()).empty();
}

void copyImage(const Device& device, const DrawnImage& drawn) {
  Image image = downloadImage(device, *drawn.image);
  annotate(image, drawn.request.scene, drawn.scene);
  const TemporaryFile png(encodePng(image, drawn.request.scene.output.look()));
  const std::vector<std::string> command = clipboardCommand();
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, png.descriptor(), STDIN_FILENO);
  // The program stays in the background with what it has open.
  for (const int output : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&files, output, "/dev/null", O_WRONLY, 0);
  pid_t child = -1;
  const int problem = posix_spawnp(&child, words[0], &files, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  int status = 0;
  if (problem != 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    fail(ErrorKind::Output, "'{}' did not take the image: copy the render command instead", command.front());
}

void saveScene(const DrawnImage& drawn, const std::string& file) {
  checkScene(sceneInto(drawn, {}), {}, {file});
  const DeferredInterrupts wholeFile;
  writeScene(file, drawn.request.scene.resolved(drawn.scene));
}

namespace {

/// Draws an image for each file, for which `set` changes the request, and writes it while the next ones are drawn.
void saveFrames(const Device& device, ImageMaker& maker, ImageRequest request, std::span<const std::string> files,
                const std::function<void(ImageRequest&, std::size_t)>& set, const Progress& progress) {
  const auto count = double(files.size());
  BackgroundWriter writer;
  for (std::size_t frame = 0; frame < files.size(); ++frame) {
    const Progress ofFrame = [&](std::string_view stage, double fraction) {
      progress(fmt::format("frame {} of {}: {}", frame + 1, files.size(), stage), (double(frame) + fraction) / count);
    };
    set(request, frame);
    writer.start(writingOf(device, maker.make(request, ofFrame), files[frame]));
  }
  writer.finish();
}

}  // namespace

void saveMoved(const Device& device, const DrawnImage& drawn, const MovedFrames& moved, const Progress& progress) {
  const std::vector<std::string> files = filesOfTurn(moved.pattern, moved.frames);
  ImageRequest request = drawn.request;
  request.scene = sceneInto(drawn, files);
  request.scene.camera.flight = moved.flight;
  checkScene(request.scene, files);
  const std::vector<FrameView> views = request.scene.views(drawn.scene, moved.frames);
  VolumeCache volumes(request.scene, drawn.scene.volume);
  ImageMaker maker(device, volumes);
  const auto look = [&](ImageRequest& of, std::size_t frame) {
    of.scene.camera.look(views[frame].camera);
    if (!views[frame].lights.empty()) of.scene.lighting.take(views[frame].lights);
  };
  saveFrames(device, maker, request, files, look, progress);
}

void saveSequence(const Device& device, const DrawnImage& drawn, const Sequence& sequence, const std::string& pattern,
                  const Progress& progress) {
  std::vector<std::string> files;
  for (const FrameNumber& number : sequence.numbers) files.push_back(frameName(pattern, number));
  ImageRequest request = drawn.request;
  ViewState view;  // so that what is automatic is that of the image, and not of each frame
  view.scene = sceneInto(drawn, files);
  view.begin(drawn.scene);
  view.keepScales(drawn.scene);
  request.scene = view.scene;
  request.scene.camera.look(drawn.scene.camera);
  request.isFrame = true;
  request.number = 1;
  request.film.clear();
  checkScene(request.scene, files);
  VolumeCache volumes(kMaxNumberedVoxels);
  ImageMaker maker(device, volumes);
  const auto open = [&](ImageRequest& of, std::size_t frame) { of.scene.input.volume = sequence.files[frame]; };
  saveFrames(device, maker, request, files, open, progress);
}

}  // namespace freevoxels
