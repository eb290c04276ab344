#pragma once
// The state of the viewer, which the panels change, and its history.

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/common/sequence.h"
#include "apps/view/image_maker.h"
#include "engine/description/flight_description.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

/// What the user edits, and undoes.
struct Edits {
  SceneDescription scene;
  Diagnosis diagnosis;
  int comparison = 0;  ///< 0 for none, or the argument of comparedMethod
  /// The sequence of which the volume is a frame.
  std::optional<Sequence> sequence;
  FlightDescription flight;  ///< the key frames of which the panel "View" makes a flight
  /// The camera of the scene's options. Unknown before the first image, which resolves what is not given.
  std::optional<Camera> camera;
  bool toneMapIsAutomatic = false;  ///< whether the output's tone map was chosen by ViewState::chooseToneMap

  /// Makes the flight of the scene's options, if they have one, that of the panel, and begins with its first camera and lights. Fails as
  /// readFlight().
  void takeFlight();
};

/// What is drawn over the image.
struct Overlays {
  bool axes = true, box = false, scaleBar = true, colorBar = true, slices = false;
};

struct ViewState : Edits {
  float split = 0.5f;  ///< fraction of the image's width left of the split
  Overlays overlays;
  std::vector<Camera> bookmarks;  ///< of the volume
  glm::dvec3 pole{0.0, 1.0, 0.0};  ///< what is up for the user (navigation.h): as the options or the volume say
  /// Set by the code that changes one of the Edits; an image is then requested and they are cleared. `moved` is for the camera
  /// alone, `retoned` for what only affects how a finished image is shown or written.
  bool changed = true, moved = false, retoned = false;

  /// The last image of all voxels in full size, and the last image.
  std::shared_ptr<const DrawnImage> whole, latest;
  /// Images a second while they follow each other; 0 for a single one.
  double imagesPerSecond = 0.0;
  /// The reason why there is no newer image.
  std::string problem;
  /// The result of the last command that is not an image.
  std::string notice;
  /// Whether `latest`, or a problem, belongs to the current options; whether `whole` does; whether a whole
  /// image of them cannot be drawn.
  bool answered = false, complete = false, failed = false;

  /// The method that is shown for comparison.
  std::optional<MethodDescription> comparedMethod() const;
  /// Takes camera, transfer function and lights that the options do not give from the first image, so that
  /// they stay as they are.
  void begin(const Scene& first);
  /// Gives the filmic tone map to an image whose light may be brighter than the screen; none to others, whose colours are those of the
  /// data. Does nothing where another one was given, and before the first image of the volume. To be called after each change.
  void chooseToneMap();
  /// How the last image is shown: a diagnosis, whose colours are no light, without a tone map that was chosen for the image.
  DisplayLook look() const;
  /// Uses this camera, unless it shows nothing: `problem` then gives the reason.
  void setCamera(const Camera& next);
  /// Opens another volume, as in the scene; in a sequence if it is one of its frames.
  void show(const SceneDescription& other, const std::optional<Sequence>& frames);
  /// Opens another frame of the sequence with the same camera. Automatic settings stay those of the frame
  /// before, so that an animation does not flicker.
  void showFrame(const std::string& file);
  /// Gives the scales of densities and emission of an image, so that all frames of a sequence have them, unless its file fixes them.
  void keepScales(const Scene& of);
  /// Draws only the voxels in the box and behind the plane, as far as they are given. The density scale stays what it is, although less
  /// of the volume is there.
  void clip(const std::optional<VoxelBox>& box, const std::optional<ClipPlane>& plane);
};

/// The scene with the density scale of what was drawn of it, where that was chosen for the volume.
SceneDescription withDensityScale(SceneDescription scene, const Scene& drawn);

/// The file that was opened: the volume, or the pattern of the sequence of which it is a frame.
inline const std::string& openedName(const Edits& edits) {
  return edits.sequence ? edits.sequence->pattern : edits.scene.input.volume;
}

/// Earlier states of what the user changes. All changes between two moments in which the user does nothing are one step.
template <typename State>
class Steps {
 public:
  /// Called once a frame. `changed`: the user has changed the state since the last call. `busy`: more of the same change may follow, such
  /// as while a mouse button is down.
  void follow(const State& now, bool changed, bool busy) {
    if (changed && settled_ && !open_) {
      past_.push_back(*settled_);
      if (past_.size() > kMax) past_.pop_front();
      future_.clear();
      open_ = true;
    }
    if (changed || busy) return;
    open_ = false;
    settled_ = now;
  }
  bool canUndo() const { return !past_.empty(); }
  bool canRedo() const { return !future_.empty(); }
  /// The state before the last step, which is then the current one; nothing if there is none.
  std::optional<State> undo(const State& now) { return step(now, past_, future_); }
  std::optional<State> redo(const State& now) { return step(now, future_, past_); }

 private:
  static constexpr std::size_t kMax = 200;

  std::optional<State> step(const State& now, std::deque<State>& from, std::deque<State>& to) {
    if (from.empty()) return std::nullopt;
    to.push_back(now);
    settled_ = std::move(from.back());
    from.pop_back();
    open_ = false;
    return settled_;
  }

  std::deque<State> past_, future_;
  std::optional<State> settled_;  ///< when the user last did nothing
  bool open_ = false;             ///< whether the last step may get more changes
};

/// The history of the edits. The camera is no edit: it stays where it is, unless another volume is shown.
class EditHistory {
 public:
  /// As Steps::follow().
  void follow(const Edits& now, bool changed, bool busy) {
    if (changed || now.camera) steps_.follow(now, changed, busy);
  }
  bool canUndo() const { return steps_.canUndo(); }
  bool canRedo() const { return steps_.canRedo(); }
  /// Restores the state before the last step, with the current image size. Does nothing if there is none.
  void undo(ViewState& state) { restore(state, steps_.undo(state)); }
  void redo(ViewState& state) { restore(state, steps_.redo(state)); }

 private:
  static void restore(ViewState& state, std::optional<Edits> edits);

  Steps<Edits> steps_;
};

/// The cameras from which a volume was seen.
class CameraHistory {
 public:
  /// As Steps::follow().
  void follow(const ViewState& state, bool moved, bool busy);
  bool canGoBack() const { return steps_.canUndo(); }
  bool canGoForward() const { return steps_.canRedo(); }
  /// Do nothing if there is no such camera, or none now.
  void goBack(ViewState& state) {
    if (state.camera) go(state, steps_.undo(*state.camera));
  }
  void goForward(ViewState& state) {
    if (state.camera) go(state, steps_.redo(*state.camera));
  }

 private:
  static void go(ViewState& state, const std::optional<Camera>& camera) {
    if (camera) state.setCamera(*camera);
  }

  std::string seen_;  ///< openedName() of what was seen
  Steps<Camera> steps_;
};

}  // namespace freevoxels
