#pragma once
// Light of all orders of scattering on the CPU in double precision: the equations that ScatteringSolver solves on the device, by plain
// iteration. Shares no code with the shaders.

#include "engine/core/stages.h"
#include "engine/scene/lighting.h"
#include "engine/scene/scattered_field.h"
#include "engine/volume/scattering_medium.h"

namespace freevoxels {

/// The light in a medium. For all orders, iterates until no cell changes by more than `tolerance` times the largest value. The result does
/// not depend on the number of threads.
ScatteredField referenceScattering(const ScatteringMedium& medium, const Lighting& lighting, double tolerance = 1e-5,
                                   const Progress& progress = {});

/// The direct light of the cells: mean radiance, weighted by extinction, of all lights together, by cell.
std::vector<glm::dvec3> referenceDirectLight(const ScatteringMedium& medium, const Lighting& lighting);

}  // namespace freevoxels
