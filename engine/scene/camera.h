#pragma once
// Cameras in world space, and the pixel rays they make in a volume's index space.

#include <glm/glm.hpp>
#include <vector>

#include "engine/scene/render_settings.h"
#include "engine/scene/source_rays.h"

namespace freevoxels {

struct Camera {
  glm::dvec3 position{0.0, 0.0, 1.0};
  glm::dvec3 lookAt{0.0};
  glm::dvec3 up{0.0, 1.0, 0.0};
  bool orthographic = false;
  double verticalFov = 35.0;        ///< degrees, perspective
  double orthographicHeight = 1.0;  ///< world units the image is high, orthographic
};

/// Fails with ErrorKind::Usage for a camera that cannot produce an image: NaN, a position at the look-at
/// point, an up direction along the view, a field of view outside of (0, 180), or a height that is not
/// positive. The sentence names the option to change.
void checkCamera(const Camera& camera);

/// The world-to-camera transform, right-handed: the camera looks along -z, x points to the right and y up.
glm::dmat4 worldToCamera(const Camera& camera);

/// worldToCamera followed by the projection to [-1,1] in x and y (y up) for this aspect ratio (width /
/// height).
glm::dmat4 worldToNdc(const Camera& camera, double aspect);

/// The part of the world that an image is to show.
struct Subject {
  glm::dvec3 centre{0.0};          ///< shown in the middle of the image
  std::vector<glm::dvec3> points;  ///< all of them are shown
  double margin = 0.03;            ///< empty border around the points, relative to their extent
};

/// The unit vector from the subject towards the eye. Azimuth, in degrees, turns about `up`, counterclockwise
/// seen from its tip; elevation, in degrees, rises from the plane across `up`. Azimuth 0 is +z if +y is up
/// and -y if +z is up: the frame is turned from +y to `up` on the shortest way.
glm::dvec3 orbitDirection(glm::dvec3 up, double azimuth, double elevation);

/// Returns `camera` with the same orientation, moved so that it looks at the subject's centre from the
/// smallest distance at which all points and the margin fit into the image.
Camera framed(const Camera& camera, const Subject& subject, double aspect);

/// The look-at point, as far away as the subject's centre, for which the points have equal margins at
/// opposite sides of the image. A perspective camera can then come nearest.
glm::dvec3 imageCentre(const Camera& camera, const Subject& subject);

/// A framed camera that looks from `orbitDirection(base.up, azimuth, elevation)`. Straight above or below,
/// where `up` does not determine the roll, it has the limit of that of lower elevations.
Camera framingCamera(const Subject& subject, double azimuth, double elevation, double aspect, const Camera& base);

inline constexpr double kDefaultAzimuth = 35.0, kDefaultElevation = 25.0;

/// The ray of image position (x, y) in pixels, (0, 0) = the top left corner of the image, in index space:
///   origin + x * originX + y * originY  +  t * (direction + x * directionX + y * directionY)
/// t is the distance from the eye plane along the viewing axis, in world units. For a perspective camera
/// originX and originY are 0, for an orthographic one directionX and directionY are.
struct PixelRays {
  glm::dvec3 origin, originX, originY;
  glm::dvec3 direction, directionX, directionY;
  bool orthographic = false;

  /// The same rays with (x, y) counted from `position`. From the middle of the image no large terms cancel in 32-bit floats.
  PixelRays countedFrom(glm::dvec2 position) const;
  /// From an index position relative to the origin to (x t, y t, t), orthographic (x, y, t).
  glm::dmat3 indexToPixel() const;
};

/// The source of the lines of sight: the eye, or for an orthographic camera the direction towards it.
RaySource eyeSource(const Camera& camera, const glm::dmat4& indexToWorld);

/// Whether the eye is inside the volume's box, faces included. Always false for an orthographic camera.
bool eyeIsInside(const Camera& camera, glm::ivec3 dimensions, const glm::dmat4& indexToWorld);

PixelRays pixelRays(const Camera& camera, glm::ivec2 imageSize, const glm::dmat4& indexToWorld);

}  // namespace freevoxels
