#pragma once
// The 26 directions that are steps between neighbouring voxels, as integers.

#include "engine/scene/directions.h"

namespace freevoxels {

inline constexpr DirectionSet kLatticeSteps = DirectionSet::Directions26;
inline constexpr int kLatticeStepCount = directionCount(kLatticeSteps);

inline glm::ivec3 latticeStep(int direction) {
  return directionCell(kLatticeSteps, direction);
}

}  // namespace freevoxels
