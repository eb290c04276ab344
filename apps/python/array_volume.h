#pragma once
// Volumes made of arrays that Python owns.

#include <pybind11/numpy.h>

#include <glm/glm.hpp>
#include <optional>

#include "engine/volume/volume.h"

namespace freevoxels {

/// Where an array stands in the world, and which of its values are none.
struct ArrayPlacement {
  /// Maps (x, y, z), the indices of a voxel in the reverse order of the array's axes, to the position of its centre.
  glm::dmat4 indexToWorld{1.0};
  std::optional<double> noData;  ///< marks voxels that hold no data, as NaN always does
};

/// Reads an array with axes (z, y, x), of real numbers or bool in the machine's byte order and any strides, without copying it
/// first; releases the GIL meanwhile. `temperature` has the same shape. Fails with ExitCode::Input for other arrays.
Volume volumeOfArray(const pybind11::array& scalars, const std::optional<pybind11::array>& temperature,
                     const ArrayPlacement& placement);

}  // namespace freevoxels
