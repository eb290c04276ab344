#pragma once
// Draws the frames of a command on one device: one volume seen by one camera or by those of a turn, or the volumes of a film.

#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/freevoxels/progress_line.h"
#include "apps/freevoxels/render_options.h"
#include "engine/renderer.h"

namespace freevoxels {

/// Reads the volumes of frames in their order, each one while the one before it is drawn: two of them are in memory.
class VolumesAhead {
 public:
  /// `scene` must outlive this object.
  VolumesAhead(const SceneOptions& scene, std::vector<std::string> inputs, std::uint64_t maximumVoxels);

  /// The next volume. Throws what reading it threw, and can be called again for the one after it.
  std::shared_ptr<const Volume> next();

 private:
  void readNext();

  const SceneOptions& scene_;
  const std::vector<std::string> inputs_;
  const std::uint64_t maximumVoxels_;
  std::size_t begun_ = 0;  ///< how many volumes are read or being read
  std::future<std::shared_ptr<const Volume>> pending_;
};

class FrameSeries {
 public:
  /// All must outlive this object; `report` is filled by `draw`.
  FrameSeries(const RenderOptions& options, const Device& device, RunReport& report);

  /// Draws and writes every frame and prints the names of its files. Neighbouring frames of one volume share its table, and
  /// are the steps of a full turn. Of several volumes, one that holds nothing becomes an image of the background, and one that
  /// cannot be read is left out: its error is printed, and at the end ExitCode::Input is thrown.
  void draw(std::span<const Frame> frames);

 private:
  void drawFilm(std::span<const Frame> frames);
  void drawVolume(std::shared_ptr<const Volume> volume, std::span<const Frame> frames);
  void begin(const Scene& view, std::size_t frames);
  void drawFrame(Renderer& renderer, const Scene& view, const FrameSettings& settings, const Frame& frame);
  void write(Image image, const Scene& view, const Frame& frame);
  void writeEmpty(const Frame& frame);
  OptionList describe(const Scene& view, const std::string& input) const;
  Scene resolve(std::shared_ptr<const Volume> volume) const;
  void addToReport(const Renderer& renderer, const Volume& volume);
  std::string prefix() const;

  const RenderOptions& options_;
  const Device& device_;
  RunReport& report_;
  ProgressLine line_;
  std::size_t frames_ = 0, written_ = 0;
  std::chrono::steady_clock::time_point begun_;
  std::optional<Scene> reference_;    ///< the first frame's with a fixed view, else the last one's
  std::vector<const Frame*> waiting_;  ///< empty frames before any frame that says how they are seen
};

}  // namespace freevoxels
