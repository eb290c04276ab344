#pragma once
// A box of constant extinction, whose images and tables are known in closed form (Beer-Lambert).

#include <glm/glm.hpp>
#include <vector>

#include "engine/image/image.h"
#include "engine/scene/camera.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Fills the world cube [-1/2, 1/2]³ along its longest axis, with cubic voxels.
glm::dmat4 cubeTransform(glm::ivec3 dimensions);

/// A transform with voxels of different length along x, y and z, and axes that are not at right angles.
glm::dmat4 shearedTransform(glm::ivec3 dimensions);

/// The number of voxels between a voxel and the outside along a direction.
int voxelsAhead(glm::ivec3 voxel, glm::ivec3 direction, glm::ivec3 dimensions);

struct BoxImage {
  Image image;                 ///< 1 - exp(-sigma * chord), averaged over 4x4 rays a pixel
  std::vector<bool> interior;  ///< pixels whose rays enter and leave the box away from its edges
};

/// All voxels of the volume have extinction `sigma`; the world around it has none.
BoxImage boxImage(const Volume& volume, double sigma, glm::vec3 color, const Camera& camera, glm::ivec2 size);

}  // namespace freevoxels
