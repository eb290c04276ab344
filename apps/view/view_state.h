#pragma once
// The state of the viewer, which the panels change.

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
  int comparison = 0;  ///< 0 for none, or the argument of comparedMethod
  float split = 0.5f;  ///< fraction of the image's width left of the split
  /// The sequence of which the volume is a frame.
  std::optional<Sequence> sequence;
  /// Set by the code that changes one of the above; an image is then requested and it is cleared.
  bool changed = true;

  /// The camera of the scene's options. Unknown before the first image, which resolves what is not given.
  std::optional<Camera> camera;
  /// The last image of all voxels in full size, and the last image.
  std::shared_ptr<const Picture> whole, latest;
  /// Images a second while they follow each other; 0 for a single one.
  double picturesPerSecond = 0.0;
  /// The reason why there is no newer image.
  std::string problem;
  /// Whether `latest`, or a problem, belongs to the current options; whether `whole` does; whether a whole
  /// image of them cannot be drawn.
  bool answered = false, complete = false, failed = false;

  /// The method that is shown for comparison.
  std::optional<MethodOptions> comparedMethod() const;
  /// Takes camera, transfer function and lights that the options do not give from the first image, so that
  /// they stay as they are.
  void begin(const Scene& first);
  /// Uses this camera, unless it shows nothing: `problem` then gives the reason.
  void look(const Camera& from);
  /// Opens another volume, as in the scene; in a sequence if it is one of its frames.
  void show(const SceneOptions& other, const std::optional<Sequence>& frames);
  /// Opens another frame of the sequence with the same camera. Automatic settings stay those of the frame
  /// before, so that an animation does not flicker.
  void showFrame(const std::string& file);
};

}  // namespace freevoxels
