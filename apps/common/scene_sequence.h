#pragma once
// Renders the frames of a film by scenes in JSON, as SceneRenderer renders one volume: for the C++ library and the Python module.

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/common/film_scenes.h"
#include "apps/common/last_frame.h"
#include "apps/common/scene_renderer.h"
#include "apps/common/sequence.h"

namespace freevoxels {

/// The view belongs to the sequence: its own keywords, and what they leave open the film as a whole (film_view.h), choose the camera, the
/// lights and the scales for all frames, as the command line does. The `orbit` of a frame moves the eye about the film's look-at point.
///
/// Any thread may call the member functions; the frames of one device are drawn one after another. A progress function may call them too,
/// except that it cannot draw with the sequence that calls it: ErrorKind::Usage.
class SceneSequence {
 public:
  /// Is told what the user should know, by the thread that draws: a warning, or a remark.
  using Report = std::function<void(const std::string& sentence, bool isWarning)>;

  /// `names` are files, procedural volumes, and patterns with a run of #; none: the volume of the scene. `keywords` are those of
  /// SceneRenderer and of openVolume, "frames", which chooses among the files of patterns as the option --frames does, and "fixed-view"
  /// (FilmScenes). Fails as findVolumes and SceneRenderer do. No volume is read yet.
  SceneSequence(std::vector<std::string> names, nlohmann::json keywords, Report report, std::shared_ptr<DeviceContext> context = nullptr);

  /// As that of SceneRenderer in a forked process.
  ~SceneSequence();

  const std::vector<NumberedVolume>& volumes() const { return found_.volumes; }

  /// Reads the options of a frame: the sequence's keywords, overridden by `more`.
  std::unique_ptr<const KeywordOptions> read(const nlohmann::json& more, std::shared_ptr<const Holdout> holdout = nullptr) const {
    return readFrame(more, keywords_, !chosenContext_, std::move(holdout));
  }
  /// Draws the frame of a volume, with channels. The first call reads up to kMaxFramesRead volumes, which decide the view. The frame drawn
  /// last stays in memory, and is not read again. Of several volumes, one that holds nothing becomes an image of the background.
  Image render(std::size_t frame, const KeywordOptions& options, const Aovs& channels, const Progress& progress);
  /// Draws all frames and writes each into the files of `patterns`, in which a run of # becomes its number; `output` are options of the
  /// section "output". `skipsExisting`: frames whose files exist are left as they are. A volume that cannot be read is left out, and at the
  /// end ErrorKind::Input is thrown. Returns the names of the files that are there.
  std::vector<std::string> save(std::span<const std::string> patterns, const nlohmann::json& output, bool skipsExisting,
                                const Progress& progress);

  /// As SceneRenderer has them.
  std::vector<StageTime> timings() const { return lastFrame_.timings(); }
  nlohmann::json camera() const { return lastFrame_.camera(); }
  const std::shared_ptr<DeviceContext>& context() const { return context_; }

 private:
  struct Given;
  SceneSequence(Given given, Report report, std::shared_ptr<DeviceContext> context);
  void chooseView(const Progress& progress);
  void takeFirstView(const Progress& progress);
  void open(std::size_t frame, const Progress& progress);
  Image drawEmpty(const KeywordOptions& options, const Aovs& channels);
  std::vector<std::vector<std::string>> filesOf(std::span<const std::string> patterns) const;

  const nlohmann::json keywords_;  ///< of frames
  const SceneDescription description_;
  const NumberedVolumes found_;
  const Report report_;
  const std::shared_ptr<DeviceContext> chosenContext_;  ///< null where the keywords choose the device
  const std::shared_ptr<DeviceContext> context_;

  // While context_->turns is held:
  bool isDrawing_ = false, isViewChosen_ = false;
  FilmScenes film_;
  std::shared_ptr<const Scene> view_;  ///< of all frames; null where each is seen by itself
  std::size_t opened_ = 0;             ///< the frame of `renderer_`
  std::unique_ptr<SceneRenderer> renderer_;

  LastFrame lastFrame_;
};

}  // namespace freevoxels
