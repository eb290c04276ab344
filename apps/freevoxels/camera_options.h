#pragma once
// The camera and the size of its image.

#include <functional>
#include <optional>
#include <vector>

#include "apps/freevoxels/option_values.h"
#include "engine/scene/camera.h"
#include "engine/volume/classification.h"

namespace freevoxels {

/// Pixels along an edge of an image.
inline constexpr int kMaximumImageEdge = 16384;

struct CameraOptions {
  std::optional<glm::dvec3> position, lookAt, up;
  std::optional<double> verticalFov, orthographicHeight;
  std::optional<glm::dvec2> orbit;
  glm::ivec2 size{1024, 1024};

  void add(CLI::App& app);
  /// Looks from exactly there, with a picture of the same size.
  void look(const Camera& from);
  /// Refuses what is wrong with any volume, before one is read: ExitCode::Usage.
  void check() const;
  /// The cameras of a full turn, of equal steps about the axis through the look-at point along `up`. What is not given frames
  /// what is seen of the volume, from one distance for all frames, upright as the volume says.
  std::vector<Camera> resolve(const Volume& volume, const Classification& classification, int frames = 1) const;
  /// The same of what is known of a volume without its values: its up direction and its content, which is asked for if it is needed.
  std::vector<Camera> resolve(glm::dvec3 upOfVolume, const std::function<Subject()>& content, int frames) const;
  void describe(OptionList& options, const Camera& resolved) const;
  /// Of what `describe` said, makes of the eye's place the orbit that it turns in, unless it was given: a turn has another
  /// distance than its first frame.
  void describeTurn(OptionList& options) const;

 private:
  glm::dvec2 angles() const;
  Camera given(glm::dvec3 upwards = {0.0, 1.0, 0.0}) const;
};

}  // namespace freevoxels
