#pragma once
// Draws the frames of a command on one device: one volume seen by one camera or by those of a turn or a flight, or the volumes of a film.

#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/common/film_scenes.h"
#include "apps/common/frame_writer.h"
#include "apps/common/render_options.h"
#include "apps/common/series_progress.h"
#include "apps/common/volumes_ahead.h"
#include "engine/image/fixed_sums.h"
#include "engine/renderer.h"

namespace freevoxels {

/// Draws frames, of one volume or of the files of a film, and writes their images while the next ones are drawn. Used by one thread.
class FrameSeries {
 public:
  /// All must outlive this object; `report` is filled by `draw`.
  FrameSeries(const RenderOptions& options, const Device& device, RunReport& report);

  /// Draws and writes every frame and prints the names of its files. Neighbouring frames of one volume share its table, and
  /// are the steps of a full turn or a flight. Of several volumes, one that holds nothing becomes an image of the background, and one that
  /// cannot be read is left out: its error is printed, and at the end ErrorKind::Input is thrown.
  void draw(std::span<const FrameJob> jobs);
  /// Prints the names of frames that other processes of the group drew, when these are done.
  void printDrawnElsewhere();

 private:
  /// What the frames of one volume have in common, and what each of them shows.
  struct VolumeView {
    Scene scene;
    std::vector<FrameView> frames;
    FrameSettings settings;
  };
  struct ReducedSums {
    std::optional<FixedSums> sums;  ///< on the process that writes the frame
    std::vector<StageTime> times;
  };
  /// The sums of the group's last frame, which are added up while the next one is drawn.
  struct PendingReduction {
    const FrameJob* job = nullptr;
    Scene view;
    bool isTransparent = false;  ///< whether nothing of the volume has extinction or emission
    std::future<ReducedSums> result;
  };

  bool needsNoVolume(std::span<const FrameJob> jobs) const;
  void drawVolumes(std::span<const FrameJob> jobs);
  void surveyFilm();
  bool drawNext(VolumesAhead& volumes, std::span<const FrameJob> jobs);
  void drawFrames(Renderer& renderer, const VolumeView& view, std::span<const FrameJob> jobs);
  void drawSliceOf(const VolumeSource& source, const VolumeView& view, std::span<const FrameJob> jobs);
  void drawShares(Renderer& renderer, const Scene& view, const FrameSettings& settings, const FrameJob& job);
  const std::shared_ptr<const Holdout>& holdoutOf(const FrameJob& job);

  VolumeView beginVolume(const std::shared_ptr<const VolumeSource>& source, std::span<const FrameJob> jobs);
  void announce(const Scene& view, std::size_t frames);
  void agree(const Scene& view, const VolumeSource& source, const FrameJob& job);
  void agreeOnCubes(Renderer& renderer, const VolumeView& view);

  void finishReduction();
  void complete(Image image, bool isTransparent, const Scene& view, const FrameJob& job);
  void writeEmpty(const FrameJob& job);
  void report(const Renderer& renderer, const Volume& volume);

  const RenderOptions& options_;
  const Device& device_;
  RunReport& report_;
  SeriesProgress progress_;
  std::optional<FilmScenes> film_;  ///< of the frames of draw()
  FrameWriter writer_;
  std::optional<std::string> holdoutFile_;  ///< FrameJob::holdout of the last frame
  std::shared_ptr<const Holdout> holdout_;  ///< what was read of it
  PendingReduction pending_;
  std::vector<const FrameJob*> drawnElsewhere_;  ///< frames of other processes of the group
  std::vector<const FrameJob*> emptyFramesToWrite_;  ///< empty frames before any frame that says how they are seen
};

}  // namespace freevoxels
