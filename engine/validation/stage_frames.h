#pragma once
// What the checks of stages share: a camera within the volume, how values are compared, and the pictures of a frame.

#include <glm/glm.hpp>

#include "engine/scene/camera.h"
#include "engine/validation/report.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Looks the way that `outside` does, from the middle of the box, where no voxel's centre is.
Camera cameraInside(const Volume& volume, const Camera& outside);

/// Infinite where only the reference is 0.
double relativeDifference(double value, double reference);
/// NaN if any is.
double largestComponent(glm::dvec3 v);

/// The device's picture beside a reference, and the difference of the two, brightened for the eye.
ReportPictures comparedPictures(const Image& picture, const Image& reference, std::string caption, std::string referenceCaption);

}  // namespace freevoxels
