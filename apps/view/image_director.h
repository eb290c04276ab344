#pragma once
// Which images are drawn, and when.

#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include "apps/view/image_pace.h"
#include "apps/view/render_thread.h"
#include "apps/view/view_state.h"

namespace freevoxels {

/// Asks for images of the options as they change: quick ones while something moves, then better ones up to the whole image.
class ImageDirector {
 public:
  using Clock = std::chrono::steady_clock;

  /// With `wholeOnly`, quick images are never asked for.
  ImageDirector(const Device& device, bool wholeOnly);

  /// Takes the images that are complete. True if ViewState::latest is another one now. `state` gets the problem of one that
  /// cannot be drawn; what was thrown is returned in `failure`.
  bool take(ViewState& state, std::exception_ptr& failure);
  /// Asks for what is needed next, of an image of `pixels`. `moves`: more changes may follow at once.
  void ask(ViewState& state, glm::ivec2 pixels, bool moves);

  /// Whether the last image is the whole image of the current options; whether there is an answer of any kind.
  bool isComplete(const ViewState& state) const;
  bool isAnswered(const ViewState& state) const { return answered_ == lastRequest_ && !isPending(state); }
  bool hasFailed(const ViewState& state) const { return failed_ == lastRequest_ && !isPending(state); }
  /// Whether nothing has to be asked for before something changes.
  bool isSettled() const { return answered_ == lastRequest_ && askedOfWhole_ == lastRequest_ && !refines_; }
  /// Whether there are layers of the image, of which it is mixed at once when colours change.
  bool mayMix(const ViewState& state) const { return layered_ && layered_->layers->fit(state.scene); }
  /// Whether a clipped volume's box and plane can be moved at once, with all voxels.
  bool isReadyToClip(const SceneDescription& scene) const;
  std::optional<std::pair<std::string, double>> activity() const;
  /// Whether a file is being read; gives that up, so that there is no image until something changes.
  bool reads() const { return volumes_.reading().has_value(); }
  void giveUpReading() { volumes_.giveUp(lastRequest_); }

  /// Abandons everything, for good, without waiting for that.
  void end();
  bool isBusy() const;

 private:
  static bool isPending(const ViewState& state) { return state.changed || state.moved; }
  void askOfChange(const ViewState& state);
  void refine(const ViewState& state);
  RenderThread* clippingThread(const ViewState& state);
  bool wantsClipping(const ViewState& state) const;
  void prepareClipping(const ViewState& state);
  void giveUpClipping();
  void refuseClipping(const SceneDescription& scene);
  void noteEdit(const SceneDescription& scene);
  bool mix(ViewState& state);
  bool wantsLayers(const ViewState& state) const;
  bool keep(ViewState& state, RenderThread& thread, const RenderThread::Result& result, std::exception_ptr& failure);
  ImageRequest request(const ViewState& state, Purpose purpose, int voxels, double quality) const;

  const Device& device_;
  VolumeCache volumes_;
  RenderThread quick_, whole_;  ///< for images of few voxels, and of all voxels
  /// For images with clipped rays of the volume that is not clipped, beside `whole_`, which has what is left of it. Null while nothing is
  /// clipped.
  std::unique_ptr<RenderThread> clipping_;
  const bool wholeOnly_;
  std::uint64_t lastRequest_ = 0, askedOfWhole_ = 0, answered_ = 0, failed_ = 0;
  std::uint64_t revision_ = 1, wholeRevision_ = 0;  ///< of everything but the camera; that of the last image of all voxels
  Clock::time_point lastChange_;
  /// Pace of images of all voxels, and of other quick images.
  AdaptiveResolution movePace_{AdaptiveResolution::Voxels::All}, editPace_{AdaptiveResolution::Voxels::Fewer};
  ImageRate rate_;
  Purpose lastPurpose_ = Purpose::Whole;
  int askedVoxels_ = kAllVoxels;  ///< of the last quick image
  bool refines_ = false;          ///< whether a step of refinement is being drawn
  bool wholeIsQuick_ = false, drawsWhole_ = false;  ///< drawsWhole_: a whole image in full size was asked for, and has not come
  double wholeTime_ = 0.0;                          ///< of the last whole image, ms
  SceneDescription asked_;                          ///< of the last request
  /// Of the last image of all voxels, where these are classified by a transfer function after interpolation.
  std::optional<SceneDescription> classified_;
  /// Of the last image of all voxels, if nothing was clipped: `whole_` can draw it with clipped rays, until it begins one that is clipped.
  std::optional<SceneDescription> unclipped_;
  std::optional<SceneDescription> clippable_;          ///< for which `clipping_` is ready
  std::optional<SceneDescription> notClippable_;       ///< which does not fit on the device twice
  std::uint64_t clippingAskedOf_ = 0;                  ///< up to this request `clipping_` only gets ready, and its images are not shown
  std::vector<std::unique_ptr<RenderThread>> ending_;  ///< given up, until they are no longer busy
  std::optional<Colors> edited_;                    ///< what was edited last, if it is nothing but colours
  bool drawsLayers_ = false, isMixed_ = false;      ///< isMixed_: ViewState::latest was mixed of layers, and nobody knows yet
  std::uint64_t layersAskedOf_ = 0;                 ///< the request of whose image layers were asked for
  std::shared_ptr<const DrawnImage> layered_;       ///< the last layers, or null
};

}  // namespace freevoxels
