#pragma once
// What is looked at, as the panels change it.

#include <memory>
#include <optional>
#include <string>

#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/scene_options.h"
#include "apps/view/picture_maker.h"

namespace freevoxels {

struct ViewState {
  SceneOptions scene;
  MethodOptions method;
  Diagnosis diagnosis;
  int comparison = 0;  ///< 0: nothing, or what comparedMethod makes of it
  float split = 0.5f;  ///< part of the picture's width that is not the other method's
  /// Set by whoever changes one of those; a picture is asked for and it is cleared.
  bool changed = true;

  /// As the scene's options say. None before the first picture, which says what is not given.
  std::optional<Camera> camera;
  /// The last picture of all voxels and in full size, and the last of all.
  std::shared_ptr<const Picture> whole, latest;
  /// Why there is no newer one.
  std::string problem;

  /// The method that is shown beside this one.
  std::optional<MethodOptions> comparedMethod() const;
  /// Looks from there.
  void look(const Camera& from);
  /// Opens another volume, framed anew, with the same method and light.
  void open(const std::string& file);
  /// `freevoxels render` with everything that makes the whole picture again, into `picture`.
  std::string commandLine(const std::string& picture) const;
};

}  // namespace freevoxels
