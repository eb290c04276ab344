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

/// Throws ExitCode::Usage for a camera that sees nothing: NaN, position at the look-at point, up along the
/// view, a field of view outside (0, 180), a height that is not positive. The sentence names the option to
/// change.
void checkCamera(const Camera& camera);

/// Right, up and backward (-view) unit vectors and the position: world -> camera, right-handed, looking along
/// -z.
glm::dmat4 worldToCamera(const Camera& camera);

/// worldToCamera followed by the projection to [-1,1] in x and y (y up) for this aspect ratio (width /
/// height).
glm::dmat4 worldToNdc(const Camera& camera, double aspect);

/// What an image is to show, in world space.
struct Subject {
  glm::dvec3 centre{0.0};          ///< in the middle of the image
  std::vector<glm::dvec3> points;  ///< all of them are in the image
  double margin = 0.03;            ///< around the points, relative to their extent
};

/// The unit vector towards the eye. Azimuth, in degrees, turns about `up` counterclockwise seen from its tip; elevation rises
/// from the plane across it. Azimuth 0 is +z where +y is up and -y where +z is up: of the shortest turn from +y to `up`.
glm::dvec3 orbitDirection(glm::dvec3 up, double azimuth, double elevation);

/// `camera` moved without being turned: it looks at the subject's centre, as near as the points and the margin fit the image.
Camera framed(const Camera& camera, const Subject& subject, double aspect);

/// The centre for which the points have equal margins to opposite sides of a perspective image too, so that such a camera
/// comes nearest. As deep in the image as the subject's.
glm::dvec3 imageCentre(const Camera& camera, const Subject& subject);

/// A framed camera that looks from `orbitDirection(base.up, azimuth, elevation)`. Straight from above or below, its up is the
/// limit of that of lower elevations.
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
};

/// Where the lines of sight start: the eye, or an orthographic camera's direction towards it.
RaySource eyeSource(const Camera& camera, const glm::dmat4& indexToWorld);

/// Whether the eye is within the volume's box, faces included. Never of an orthographic camera.
bool eyeIsInside(const Camera& camera, glm::ivec3 dimensions, const glm::dmat4& indexToWorld);

/// An eye is near to the volume's box within this part of the box's longest edge.
inline constexpr double kNearBox = 0.5;

/// Auto of a volume that shines is Exact: a flame behind smoke shows as many times the table's error as it is
/// bright.
inline AttenuationLookup lookupFor(AttenuationLookup lookup, bool shines) {
  return lookup == AttenuationLookup::Auto && shines ? AttenuationLookup::Exact : lookup;
}

/// What share of a voxel's optical depth to the eye is that along rays from it, the rest being the table's: 1
/// of Exact, 0 of the table's own look-ups. Of Auto 1 for an eye inside, as the table tells how much light
/// leaves the volume; outside less the farther the eye is from the box, down to 0 where it is no longer near,
/// so that no step shows.
double rayShare(AttenuationLookup lookup, const Camera& camera, glm::ivec3 dimensions,
                const glm::dmat4& indexToWorld);

PixelRays pixelRays(const Camera& camera, glm::ivec2 imageSize, const glm::dmat4& indexToWorld);

}  // namespace freevoxels
