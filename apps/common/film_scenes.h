#pragma once
// The scenes of the frames of a film, which options, the film as a whole, or its first frame decide.

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/film_view.h"
#include "engine/image/image.h"
#include "engine/scene/render_settings.h"

namespace freevoxels {

class FilmScenes {
 public:
  /// `inputs` are the volumes in their order. `isFixed`: whether all frames are seen as the first one that holds anything, where the
  /// description leaves that open; false: each by itself; nothing: as the film is (film_view.h), if there are several volumes.
  FilmScenes(SceneDescription description, std::vector<std::string> inputs, std::optional<bool> isFixed)
      : description_(std::move(description)), inputs_(std::move(inputs)), isFixed_(isFixed) {}

  const std::vector<std::string>& inputs() const { return inputs_; }
  /// Whether there are several volumes, of which a frame may hold nothing.
  bool isFilm() const { return inputs_.size() > 1; }
  /// Whether frames are seen as a reference is, and not each by itself.
  bool isFixed() const { return isFixed_.value_or(isFilm()); }
  bool isSurveyed() const { return isSurveyed_; }
  /// Whether the film decides how its frames are seen.
  bool isSeenAsAWhole() const { return isFilm() && !isFixed_; }

  /// Makes the film the reference, where it decides. Nothing where it does not, or where no frame can be drawn. `progress` may abandon it.
  std::optional<FilmView> survey(const Progress& progress = {});
  /// Reads a volume, of which `turn` frames are drawn: of several, completely. Any thread may call it after survey().
  std::shared_ptr<const VolumeSource> read(const std::string& input, int turn = 1, const Progress& progress = {}) const;
  /// The scene of a volume that is as the reference, or the reference from now on. Otherwise it is seen by itself.
  Scene resolve(const std::string& input, std::shared_ptr<const Volume> volume);

  /// What the other frames are seen as, or, where each is seen by itself, the last one; nothing before.
  const std::optional<Scene>& reference() const { return reference_; }
  /// Whether there is a reference. Any thread may call it.
  bool hasReference() const { return hasReference_; }

 private:
  const SceneDescription description_;
  const std::vector<std::string> inputs_;
  const std::optional<bool> isFixed_;
  bool isSurveyed_ = false;
  std::optional<Scene> reference_;
  std::atomic<bool> hasReference_ = false;
};

/// Says which frames decided the view.
std::string remarkOf(const FilmView& view);

/// The image of a frame that holds nothing.
Image emptyImage(const FrameSettings& settings);

}  // namespace freevoxels
