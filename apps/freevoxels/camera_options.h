#pragma once
// The camera and the size of its image.

#include <optional>
#include <vector>

#include "apps/freevoxels/option_values.h"
#include "engine/splatting/camera.h"

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
  /// What is not given frames the volume: the position orbits the look-at point, which is the centre of the
  /// box.
  Camera resolve(const Volume& volume) const;
  /// The cameras of a full turn, the first being `resolve`'s but for its distance. A position that was given
  /// turns about the axis through the look-at point along `up`; the framing orbit turns about +y, with one
  /// distance for all frames.
  std::vector<Camera> resolveOrbit(const Volume& volume, int frames) const;
  void describe(OptionList& options, const Camera& resolved) const;
  /// Of what `describe` said, makes of the eye's place the orbit that it turns in, where it does: with
  /// another up than +y that is another turn than the place's.
  void describeTurn(OptionList& options) const;

 private:
  glm::dvec2 angles() const;
  Camera given() const;
};

}  // namespace freevoxels
