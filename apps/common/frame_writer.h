#pragma once
// Writes the files of frames, with how each frame is made again alone, and prints their names.

#include <map>
#include <string>
#include <vector>

#include "apps/common/background_writer.h"
#include "apps/common/render_options.h"
#include "apps/common/series_progress.h"
#include "engine/image/fixed_sums.h"
#include "engine/image/image.h"

namespace freevoxels {

class FrameWriter {
 public:
  /// All must outlive this object. The device and the content hash of `report` go into the files.
  FrameWriter(const RenderOptions& options, const RunReport& report, SeriesProgress& progress)
      : options_(options), report_(report), progress_(progress) {}

  /// Waits for the frame before, then begins to write, which goes on while the next frame is drawn. `job` must remain until finish().
  /// Throws what writing the frame before threw.
  void write(Image image, const Scene& view, const FrameJob& job);
  /// Writes the sums of shares, and waits.
  void writeSums(const FixedSums& sums, const Scene& view, const FrameJob& job);
  /// Waits until the last frame is written, and prints the names of its files.
  void finish();
  /// Prints the names of a frame's files, where this process prints.
  void printNames(const FrameJob& job);
  const std::vector<StageTime>& times() const { return writer_.times(); }

 private:
  OptionList describe(const Scene& view, const FrameJob& job) const;
  std::map<std::string, std::string> facts() const;

  const RenderOptions& options_;
  const RunReport& report_;
  SeriesProgress& progress_;
  BackgroundWriter writer_;
  const FrameJob* written_ = nullptr;  ///< that `writer_` is writing
};

}  // namespace freevoxels
