#include "apps/common/turntable_command.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <utility>

#include "apps/common/frame_names.h"
#include "apps/common/sequence.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr const char* kTurntableExamples =
    "A run of # in the file name of each OUT becomes the number of the frame, from 0.\n"
    "With --orbit (or neither) the camera turns about +y, its distance the least from which no frame cuts\n"
    "the volume; a --camera-position turns about the axis through --look-at along --up. With --flight it flies\n"
    "through key frames.\n"
    "Examples:\n"
    "  freevoxels turntable cloud.vdb orbit_####.png --frames 120 --background 0.02,0.03,0.05\n"
    "  freevoxels turntable cloud.vdb orbit_###.exr orbit_###.png --orbit 0,15 --size 1920x1080\n"
    "  freevoxels turntable scan.vdb orbit_###.png --camera-position 300,0,80 --up 0,0,1\n"
    "  freevoxels turntable cloud.vdb orbit_####.png --frames 120 --range 60-119 --skip-existing\n"
    "  freevoxels turntable cloud.vdb flight_####.png --frames 240 --flight flight.json\n"
    "  freevoxels turntable --scene apps/scenes/cloud.json cloud_###.png\n";

}  // namespace

void TurntableCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("turntable", "Draw a full turn around a volume, or a flight, an image for each frame");
  options_.add(*command);
  options_.scene.addField(*command, "frames", fmt::format("Frames of the turn or the flight [{}]", kDefaultFrames));
  addText(*command, "--range", "A-B:STEP", range_, "Numbers of the frames to draw; A-B, A- and A will do [all]")->group("Sequence");
  options_.addSkipExisting(*command);
  if (options_.group != nullptr)
    addWholeNumber(*command, "--ranks-per-frame", "N", ranksPerFrame_,
                   "Ranks that draw a frame together; groups of so many draw frames side by side [all]", {1.0, double(kShares)})
        ->group("Device");
  command->footer(kTurntableExamples);
  command->callback([this] {
    if (ranksPerFrame_) options_.group->splitFrames(*ranksPerFrame_);
    options_.scene.takeScene("_####.png");
    const SceneDescription& scene = options_.scene.description;
    refuseTurnOfSlice(scene);
    std::vector<FrameJob> frames(std::size_t(scene.camera.frames.value_or(kDefaultFrames)), {.input = scene.input.volume, .files = {}});
    for (std::size_t i = 0; i < frames.size(); ++i) {
      for (const std::string& pattern : options_.scene.files) frames[i].files.push_back(frameName(pattern, int(i)));
      frames[i].holdout = holdoutOfTurn(scene.camera, int(i), int(frames.size()));
    }
    skipOthers(frames);
    options_.run(std::move(frames));
  });
}

/// Skips the frames that are not in --range.
void TurntableCommand::skipOthers(std::vector<FrameJob>& frames) const {
  if (!range_) return;
  const FrameRange range = readFrameRange("--range", *range_);
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].isSkipped = !range.contains(int(i));
  if (std::ranges::all_of(frames, &FrameJob::isSkipped))
    fail(ErrorKind::Usage, "--range {} has no frame of this turn, whose {} are numbered from 0: name one up to {}", *range_, frames.size(),
         frames.size() - 1);
}

}  // namespace freevoxels
