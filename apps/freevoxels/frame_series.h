#pragma once
// Draws the frames of a command on one device: one volume seen by one camera or by those of a turn, or the volumes of a film.

#include <future>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/freevoxels/background_writer.h"
#include "apps/freevoxels/progress_line.h"
#include "apps/freevoxels/region_choice.h"
#include "apps/freevoxels/render_options.h"
#include "apps/freevoxels/volumes_ahead.h"
#include "engine/image/fixed_sums.h"
#include "engine/renderer.h"

namespace freevoxels {

class FrameSeries {
 public:
  /// All must outlive this object; `report` is filled by `draw`.
  FrameSeries(const RenderOptions& options, const Device& device, RunReport& report);

  /// Draws and writes every frame and prints the names of its files. Neighbouring frames of one volume share its table, and
  /// are the steps of a full turn. Of several volumes, one that holds nothing becomes an image of the background, and one that
  /// cannot be read is left out: its error is printed, and at the end ErrorKind::Input is thrown.
  void draw(std::span<const Frame> frames);
  /// Prints the names of frames that other processes of the group drew, when these are done.
  void printDrawnElsewhere();

 private:
  void drawFilm(std::span<const Frame> frames);
  void drawFitting(std::shared_ptr<const Volume> volume, std::span<const Frame> frames);
  void drawVolume(std::shared_ptr<const Volume> volume, const PieceDrawing& pieces, std::span<const Frame> frames);
  void drawPieces(const PieceDrawing& pieces, int level, std::span<const Frame> frames);
  std::vector<Camera> beginVolume(Scene& view, std::span<const Frame> frames, const fvx::FvxFile* file = nullptr);
  /// Draws with a Renderer, a StreamedRenderer or a RegionRenderer.
  template <typename AnyRenderer>
  void drawFrames(AnyRenderer& renderer, FrameSettings settings, Scene view, const std::vector<Camera>& cameras,
                  std::span<const Frame> frames, std::size_t stagesBefore);
  void begin(const Scene& view, std::size_t frames);
  void agree(const Scene& view, const fvx::FvxFile* file);
  template <typename AnyRenderer>
  void drawFrame(AnyRenderer& renderer, const Scene& view, const FrameSettings& settings, const Frame& frame);
  template <typename AnyRenderer>
  void drawShares(AnyRenderer& renderer, const Scene& view, const FrameSettings& settings, const Frame& frame);
  template <typename AnyRenderer>
  FixedSums drawSums(AnyRenderer& renderer, const Camera& camera, const FrameSettings& settings);
  void finishAddingUp();
  void complete(Image image, bool isTransparent, const Scene& view, const Frame& frame);
  void write(Image image, const Scene& view, const Frame& frame);
  void writeEmpty(const Frame& frame);
  void finishWriting();
  void printNames(const Frame& frame);
  SceneDescription sceneOf(const std::string& input) const;
  OptionList describe(const Scene& view, const std::string& input) const;
  std::map<std::string, std::string> facts() const;
  Scene resolve(std::shared_ptr<const Volume> volume, const std::string& input) const;
  template <typename AnyRenderer>
  void addToReport(const AnyRenderer& renderer, const Volume& volume);
  std::string prefix() const;

  struct AddedUp {
    std::optional<FixedSums> sums;  ///< on the process that writes the frame
    std::vector<StageTime> times;
  };
  /// The sums of the group's last frame, which are added up while the next one is drawn.
  struct AddingUp {
    const Frame* frame = nullptr;
    Scene view;
    bool isTransparent = false;  ///< whether nothing of the volume has extinction or emission
    std::future<AddedUp> result;
  };

  const RenderOptions& options_;
  const Device& device_;
  RunReport& report_;
  ProgressLine line_;
  std::size_t frames_ = 0, drawn_ = 0;
  std::chrono::steady_clock::time_point begun_;
  std::optional<Scene> reference_;    ///< the first frame's with a fixed view, else the last one's
  BackgroundWriter writer_;
  AddingUp addingUp_;
  const Frame* written_ = nullptr;  ///< that `writer_` is writing
  std::vector<const Frame*> drawnElsewhere_;  ///< frames of other processes of the group
  std::vector<const Frame*> waiting_;  ///< empty frames before any frame that says how they are seen
};

}  // namespace freevoxels
