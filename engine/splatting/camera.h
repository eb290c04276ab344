#pragma once
// Cameras in world space, and the pixel rays they make in a volume's index space.

#include <glm/glm.hpp>

#include "engine/attenuation/ray_fans.h"
#include "engine/splatting/render_settings.h"
#include "engine/volume/volume.h"

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

/// A camera that looks at the centre of the volume's box from `azimuth` (degrees about +y, 0 = from +z) and
/// `elevation` (degrees above the xz plane), as near as the box's corners still fit the image.
Camera framingCamera(const Volume& volume, double azimuth, double elevation, double aspect,
                     const Camera& base);

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
