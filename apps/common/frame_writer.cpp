#include "apps/common/frame_writer.h"

#include <utility>

#include "apps/common/program.h"

namespace freevoxels {

void FrameWriter::write(Image image, const Scene& view, const FrameJob& job) {
  progress_.begin("writing " + job.files.front());
  if (usesStandardOutput(job.files)) finish();
  const SceneDescription scene = options_.scene.description.of(job.input);
  writer_.start(imageWriting(std::move(image), scene, job.files, view, "render", describe(view, job), facts()),
                [this, &job] { printNames(job); });
}

void FrameWriter::writeSums(const FixedSums& sums, const Scene& view, const FrameJob& job) {
  finish();
  const DeferredInterrupts wholeFile;
  freevoxels::writeSums(job.files.front(), sums, imageHeader(options_.scene.description, view, "render", describe(view, job), facts()));
  printNames(job);
}

void FrameWriter::finish() {
  writer_.finish();
}

void FrameWriter::finishAfterFailure() noexcept {
  try {
    finish();
  } catch (...) {
  }
}

void FrameWriter::printNames(const FrameJob& job) {
  progress_.erase();
  if (options_.messages.quiet || !options_.leads()) return;
  freevoxels::printNames(job.files);
}

/// The options with which `render` makes this frame alone.
OptionList FrameWriter::describe(const Scene& view, const FrameJob& job) const {
  return options_.scene.ownOptions(options_.scene.description.of(job.input).resolved(view));
}

/// What an .exr says of its making besides the options.
std::map<std::string, std::string> FrameWriter::facts() const {
  std::map<std::string, std::string> facts{{"device", report_.device.name}, {"driver", report_.device.driver}};
  if (options_.drawsShares()) {
    facts["share"] = sharePartText(options_.shares.whole());
    facts["content"] = report_.contentHash;
    if (options_.shares.coloredParts) facts["color-parts"] = std::to_string(*options_.shares.coloredParts);
  }
  return facts;
}

}  // namespace freevoxels
