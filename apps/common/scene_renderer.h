#pragma once
// Renders one volume by scenes in JSON: the common base of the C++ library and the Python module.

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/device_context.h"
#include "apps/common/kept_renderer.h"
#include "apps/common/keyword_options.h"
#include "apps/common/last_frame.h"
#include "apps/common/shared_volume.h"
#include "engine/scene/draft_quality.h"

namespace freevoxels {

/// Reads a file or makes "procedural:NAME"; of a baked file what describes it. `context` is null where the keywords choose the device.
/// `keywords` are the grid, the resolution and the scene of later frames, which decides what other grids are needed.
/// Without a file it is the volume of the scene. `progress` may abandon it.
/// Fails as readVdb does, and for a baked file as FvxFile does.
std::shared_ptr<const SharedVolume> openVolume(const std::string& file, const nlohmann::json& keywords,
                                               const std::shared_ptr<DeviceContext>& context = nullptr, const Progress& progress = {});

/// Writes an image as `freevoxels render` does, with the channels that it has. `keywords` are options of the section "output".
void saveImage(const std::string& file, const Image& image, const nlohmann::json& keywords);

/// A scene file as keywords, with absolute names of files. Fails with ErrorKind::Input.
nlohmann::json loadScene(const std::filesystem::path& file);
/// SceneFile::warnings().
std::vector<std::string> sceneWarnings(const std::filesystem::path& file);
/// Writes keywords as a scene file, with names of files relative to its folder.
void saveScene(const std::filesystem::path& file, const nlohmann::json& keywords);

/// Reads the options of one frame: `own`, overridden by `more`. `choosesDevice`: whether they choose the device. `holdout` is in place of
/// the file that they name; null if there is none. `budget`: KeywordOptions::budget. Fails for a turn, and for a budget that is no time.
std::unique_ptr<const KeywordOptions> readFrame(const nlohmann::json& more, const nlohmann::json& own, bool choosesDevice,
                                                std::shared_ptr<const Holdout> holdout = nullptr, std::optional<double> budget = {});

/// The options with what a frame has besides its scene, as for readFrame().
KeywordOptions withFrame(KeywordOptions options, std::shared_ptr<const Holdout> holdout, std::optional<double> budget);

/// What the frames of a full turn around the volume, or of a flight, show. The first frame that is drawn resolves it for all, so that they
/// are of one flight even if its file changes. It belongs to one renderer and one scene.
struct TurnViews {
  int frames = 1;
  // While the turn of the renderer's context is held:
  BakedNeed need;
  std::optional<Lighting> lighting;
  std::vector<FrameView> ofFrames;  ///< empty before a frame was drawn
};

/// A frame of a turn.
struct TurnStep {
  int frame = 0;  ///< 0 <= frame < turn.frames
  TurnViews& turn;
};

/// The view belongs to the renderer: its own keywords choose the distance of the eye, the look-at point and the default lights, and the
/// `orbit` of a frame moves the eye about that point, so that neither size nor light change from frame to frame.
///
/// Any thread may call the member functions; the frames of one device are drawn one after another. A progress function may call them
/// too, except that it cannot draw with the renderer that calls it: ErrorKind::Usage.
class SceneRenderer {
 public:
  /// `keywords` (KeywordOptions) hold for every frame. The table is made for the first frame that needs it. If `context` is
  /// null, the keywords choose the device, which is opened here. `film`: how all frames of a film are seen, of which the volume is one;
  /// its classification, camera and lights are in place of those that the keywords leave open.
  SceneRenderer(std::shared_ptr<const SharedVolume> volume, nlohmann::json keywords, std::shared_ptr<DeviceContext> context = nullptr,
                std::shared_ptr<const Scene> film = nullptr);
  /// In a process forked from the renderer's own, what the renderer has on the device is given up, as it cannot be freed there.
  ~SceneRenderer();

  /// Reads the options of a frame: the renderer's keywords, overridden by `more`. `holdout` and `budget` as for readFrame().
  std::unique_ptr<const KeywordOptions> read(const nlohmann::json& more, std::shared_ptr<const Holdout> holdout = nullptr,
                                             std::optional<double> budget = {}) const {
    return readFrame(more, keywords_, choosesDevice_, std::move(holdout), budget);
  }

  /// Draws a frame, with channels. What frames share is made again only if the options change it.
  Image render(const KeywordOptions& options, const Aovs& channels, const Progress& progress);
  /// Draws a frame of a turn or a flight, with the cameras and the light of `freevoxels turntable`. `options` have the camera of the turn,
  /// and but for holdout and budget are the same for all frames of `step.turn`.
  Image renderTurn(const KeywordOptions& options, TurnStep step, const Aovs& channels, const Progress& progress);
  /// The same frame, which stays on the device, complete.
  std::shared_ptr<const FrameTargets> renderOnDevice(const KeywordOptions& options, bool depth, const Progress& progress);

  /// Times of the stages that the last complete frame ran, those of data that it made included. Does not wait for a frame that is being
  /// drawn.
  std::vector<StageTime> timings() const { return lastFrame_.timings(); }
  /// The camera of the last complete frame, as keywords that give it; an empty object before.
  nlohmann::json camera() const { return lastFrame_.camera(); }
  const std::shared_ptr<DeviceContext>& context() const { return context_; }

 private:
  Image drawImage(const KeywordOptions& options, std::optional<TurnStep> step, const Aovs& channels, const Progress& progress);
  /// Prepares a frame and returns what `work`, a drawing function of Renderer, makes of it.
  void prepare(const KeywordOptions& options, std::optional<TurnStep> step, const Progress& progress);
  Image drawSlice(const KeywordOptions& options, const Aovs& channels, const Progress& progress);
  template <typename Work>
  auto draw(const KeywordOptions& options, std::optional<TurnStep> step, bool depth, const Progress& progress, const Work& work);
  void takeSource(const SceneDescription& description, std::optional<TurnStep> step, const Progress& progress);
  void classify(const SceneDescription& description);
  void resolveLikeFilm(const SceneDescription& description);
  void resolveTurn(const SceneDescription& description, TurnStep step);
  void resolveView(const SceneDescription& description);
  void beginDraft(FrameSettings& settings, double budget);
  void complete(glm::ivec2 size);

  const std::shared_ptr<const SharedVolume> volume_;
  const nlohmann::json keywords_;
  const std::shared_ptr<const Scene> film_;  ///< null where the volume is seen by itself
  const bool choosesDevice_;  ///< whether the keywords choose the device
  const std::shared_ptr<DeviceContext> context_;
  SceneDescription own_;  ///< of the renderer's own keywords
  std::vector<std::shared_ptr<const Volume>> inMemory_;  ///< the further volumes of own_ that have no file

  // While context_->turns is held:
  bool isDrawing_ = false;
  BakedNeed need_;
  std::shared_ptr<const VolumeSource> source_;  ///< of the last frame, what it needed
  Scene scene_;                                 ///< of the last frame, with what is known of the volume
  std::optional<std::string> classification_;   ///< the fields of which scene_.classification was made
  std::string added_;                           ///< the fields of which scene_.added was made
  KeptRenderer kept_;
  std::optional<DraftQuality> draft_;  ///< of the last frame with a budget
  struct FrameTime {
    double milliseconds, quality;
  };
  std::optional<FrameTime> lastTime_;  ///< of the last frame, with what it made

  LastFrame lastFrame_;
};

}  // namespace freevoxels
