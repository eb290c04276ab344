#pragma once
// What is looked at, as the panels change it.

#include <memory>
#include <optional>
#include <string>

#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/scene_options.h"
#include "apps/view/picture_maker.h"
#include "apps/freevoxels/sequence.h"

namespace freevoxels {

struct ViewState {
  SceneOptions scene;
  MethodOptions method;
  Diagnosis diagnosis;
  int comparison = 0;  ///< 0: nothing, or what comparedMethod makes of it
  float split = 0.5f;  ///< part of the picture's width that is not the other method's
  /// That the volume is a frame of.
  std::optional<Sequence> sequence;
  /// Set by whoever changes one of those; a picture is asked for and it is cleared.
  bool changed = true;

  /// As the scene's options say. None before the first picture, which says what is not given.
  std::optional<Camera> camera;
  /// The last picture of all voxels and in full size, and the last of all.
  std::shared_ptr<const Picture> whole, latest;
  /// How many are shown while they follow each other; 0 of a single one.
  double picturesPerSecond = 0.0;
  /// Why there is no newer one.
  std::string problem;
  /// Whether `latest`, or a problem, answers what the options say; whether `whole` does; whether a whole
  /// picture of it cannot be drawn.
  bool answered = false, complete = false, failed = false;

  /// The method that is shown beside this one.
  std::optional<MethodOptions> comparedMethod() const;
  /// Takes from the first picture the camera, the transfer function and the lights that its options do not say, so that they stay where they are.
  void begin(const Scene& first);
  /// Looks from there, unless nothing is seen from there: `problem` says why.
  void look(const Camera& from);
  /// Another volume, as the scene has it; of a sequence where it is one of its frames.
  void show(const SceneOptions& other, const std::optional<Sequence>& frames);
  /// Another frame of the sequence, from the same place. What would be chosen for its picture stays as it was
  /// chosen for the one before, so that a film does not flicker.
  void showFrame(const std::string& file);
};

}  // namespace freevoxels
