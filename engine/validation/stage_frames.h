#pragma once
// Shared by the checks of stages: a camera inside the volume, comparisons of values, and the images of a
// frame.

#include <glm/glm.hpp>

#include "engine/scene/camera.h"
#include "engine/validation/report.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// A camera that looks in the direction of `outside` from the middle of the box, where no voxel has its
/// centre.
Camera cameraInside(const Volume& volume, const Camera& outside);

/// The relative error; infinite if only the reference is 0.
double relativeDifference(double value, double reference);
/// The maximum, or NaN if any figure is NaN.
double largestComponent(glm::dvec3 v);

/// The device's image beside a reference, and their difference, brightened.
ImageRow comparedImages(const Image& image, const Image& reference, std::string caption, std::string referenceCaption);

}  // namespace freevoxels
