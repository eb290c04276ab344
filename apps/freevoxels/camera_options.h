#pragma once
// The camera and the size of its image.

#include <functional>
#include <optional>
#include <vector>

#include "apps/freevoxels/option_values.h"
#include "engine/scene/camera.h"
#include "engine/volume/classification.h"

namespace freevoxels {

/// Largest number of pixels along an edge of an image.
inline constexpr int kMaximumImageEdge = 16384;

struct CameraOptions {
  std::optional<glm::dvec3> position, lookAt, up;
  std::optional<double> verticalFov, orthographicHeight;
  std::optional<glm::dvec2> orbit;
  glm::ivec2 size{1024, 1024};

  void add(CLI::App& app);
  /// Sets the options to this camera, with the same image size.
  void look(const Camera& from);
  /// Fails with ErrorKind::Usage for options that are wrong for every volume, before one is read.
  void check() const;
  /// The cameras of a full turn in equal steps about the axis through the look-at point along `up`. Options
  /// that are not given are chosen so that the visible part of the volume fills the image, from one distance
  /// for all frames, upright as the volume says.
  std::vector<Camera> resolve(const Volume& volume, const Classification& classification, int frames = 1) const;
  /// The same of what is known of a volume without its values: its up direction and its content, which is asked for if it is needed.
  std::vector<Camera> resolve(glm::dvec3 upOfVolume, const std::function<Subject()>& content, int frames) const;
  void describe(OptionList& options, const Camera& resolved) const;
  /// Changes the output of `describe` for a turntable: replaces the eye's position by the orbit, unless the
  /// position was given, since a turntable has another distance than its first frame alone.
  void describeTurn(OptionList& options) const;

 private:
  glm::dvec2 angles() const;
  Camera given(glm::dvec3 upwards = {0.0, 1.0, 0.0}) const;
};

}  // namespace freevoxels
