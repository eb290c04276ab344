#include "engine/validation/axis_change.h"

namespace freevoxels {

glm::ivec3 AxisChange::direction(glm::ivec3 old) const {
  glm::ivec3 changed;
  for (int i = 0; i < 3; ++i) changed[i] = mirrored[i] ? -old[axis[i]] : old[axis[i]];
  return changed;
}

glm::ivec3 AxisChange::voxel(glm::ivec3 old, glm::ivec3 dimensions) const {
  glm::ivec3 changed;
  for (int i = 0; i < 3; ++i)
    changed[i] = mirrored[i] ? dimensions[axis[i]] - 1 - old[axis[i]] : old[axis[i]];
  return changed;
}

Volume AxisChange::apply(const Volume& volume) const {
  Volume changed = volume;
  glm::dvec4 origin = volume.indexToWorld[3];
  for (int i = 0; i < 3; ++i) {
    const int old = axis[i];
    changed.dimensions[i] = volume.dimensions[old];
    changed.indexToWorld[i] = (mirrored[i] ? -1.0 : 1.0) * volume.indexToWorld[old];
    if (mirrored[i]) origin += double(volume.dimensions[old] - 1) * volume.indexToWorld[old];
  }
  changed.indexToWorld[3] = origin;
  forEachGrid([this](ScalarBricks& values) { values = apply(values); }, changed);
  return changed;
}

ScalarBricks AxisChange::apply(const ScalarBricks& scalars) const {
  const glm::ivec3 n = scalars.dimensions();
  ScalarBricks changed({n[axis[0]], n[axis[1]], n[axis[2]]});
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) changed.set(voxel({x, y, z}, n), scalars.at({x, y, z}));
  return changed;
}

}  // namespace freevoxels
