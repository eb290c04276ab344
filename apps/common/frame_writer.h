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

  /// Begins to write, beside the frames before, which goes on while the next frames are drawn. Waits while too many are being written, and
  /// for an image to be on standard output before the next one. `job` must remain until finish(). Prints the names of files in the order of
  /// frames. Throws what writing a frame before threw.
  void write(Image image, const Scene& view, const FrameJob& job);
  /// Writes the sums of shares, and waits.
  void writeSums(const FixedSums& sums, const Scene& view, const FrameJob& job);
  /// Waits until all frames are written, and prints the names of their files.
  void finish();
  /// The same where the next frame could not be drawn. What writing throws is not more than that.
  void finishAfterFailure() noexcept;
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
};

}  // namespace freevoxels
