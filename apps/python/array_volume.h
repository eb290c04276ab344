#pragma once
// Volumes of NumPy arrays.

#include <pybind11/numpy.h>

#include <glm/glm.hpp>
#include <optional>

#include "engine/volume/volume.h"

namespace freevoxels {

/// The place of an array in the world, and its marker of no data.
struct ArrayPlacement {
  /// Maps a voxel (x, y, z), its indices in the reverse order of the array's axes, to the position of its
  /// centre.
  glm::dmat4 indexToWorld{1.0};
  /// Value of voxels without data, in addition to NaN: a number, which is compared in the array's own type, or None.
  pybind11::object noData = pybind11::none();
};

/// Reads an array with axes (z, y, x), of real numbers or bool in the machine's byte order and with any
/// strides, without copying it first. Releases the GIL meanwhile. `temperature` must have the same shape.
/// Fails with ErrorKind::Input for other arrays, and for a value of no data that neither array can hold.
Volume volumeOfArray(const pybind11::array& scalars, const std::optional<pybind11::array>& temperature,
                     const ArrayPlacement& placement);

}  // namespace freevoxels
