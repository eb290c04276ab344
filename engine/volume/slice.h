#pragma once
// Slices: the values of a volume on a plane across an axis of the world, drawn from the front of the plane without perspective.

#include <glm/glm.hpp>

#include "engine/image/image.h"
#include "engine/scene/camera.h"
#include "engine/volume/classification.h"

namespace freevoxels {

/// A plane across an axis of the world.
struct SlicePlane {
  int axis = 2;            ///< of the world: 0 x, 1 y, 2 z
  double position = 0.0;   ///< along the axis, in world units or per cent
  bool isPercent = false;  ///< whether 0 and 100 are the ends of the volume's box along the axis

  bool operator==(const SlicePlane&) const = default;
};

/// A box along the axes of the world.
struct WorldBox {
  glm::dvec3 low{0.0}, high{0.0};
};

/// The box around all voxels of a volume, to their outer faces.
WorldBox worldBox(const Volume& volume);

/// The directions of a slice's image in the world.
struct SliceAxes {
  glm::dvec3 right{0.0}, up{0.0};
};

/// How slices of a volume with this up direction are seen, which counts as its nearest of +-y and +-z: a slice across it from below, with x
/// to the right; others with it upwards, that across x from +x. With up +z and the axes of scans (LPS) these are the views of radiology:
/// axial from the feet, coronal from the front, sagittal from the left.
SliceAxes sliceAxes(int axis, glm::dvec3 up);

/// The camera of the slice: orthographic, looking at the middle of the plane, with the box as large as it fits into an image of this size.
/// Fails with ErrorKind::Usage where the plane does not meet the box.
Camera sliceCamera(const SlicePlane& plane, glm::dvec3 up, const WorldBox& box, glm::ivec2 size);

/// The pixels of a slice in the index space of a volume.
struct SlicePixels {
  glm::dvec3 corner{0.0};            ///< the outer corner of the top left pixel
  glm::dvec3 right{0.0}, down{0.0};  ///< from pixel to pixel
};

/// Those of the plane across the view of an orthographic camera through its look-at point.
SlicePixels slicePixels(const Volume& volume, const Camera& camera, glm::ivec2 size);

/// The image of a slice, linear and premultiplied: colours of the transfer function at interpolated values, whatever their opacity, and
/// nothing where there are no voxels with data. Labels (labels.h) have their colours and are not interpolated; channels (channels.h) have
/// the sums of their colours over black. A pixel is the mean of as many samples as it has voxels along its edges.
Image drawSlice(const Volume& volume, const Classification& classification, const SlicePixels& pixels, glm::ivec2 size);

}  // namespace freevoxels
