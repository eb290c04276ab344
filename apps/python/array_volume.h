#pragma once
// Volumes of NumPy arrays.

#include <pybind11/pybind11.h>

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine/volume/channels.h"
#include "engine/volume/labels.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// The place of an array in the world, and its marker of no data.
struct ArrayPlacement {
  /// Maps a voxel (x, y, z), its indices in the reverse order of the array's axes, to the position of its
  /// centre.
  glm::dmat4 indexToWorld{1.0};
  /// Value of voxels without data, in addition to NaN: a number, which is compared in the array's own type, or None.
  pybind11::object noData = pybind11::none();
  std::optional<Labels> labels = std::nullopt;  ///< how the values are drawn if they are labels
  std::vector<ChannelStyle> channels = {};      ///< of an array with four axes, the first of which counts channels
};

/// Reads an array (numpy_array.h) with axes (z, y, x), or (channel, z, y, x), with any strides and byte order, without copying it first.
/// Releases the GIL meanwhile. `temperature` is None or must have the same shape. Fails with ErrorKind::Input for other arrays, and for a
/// value of no data that neither array can hold.
Volume volumeOfArray(const pybind11::object& array, const pybind11::object& temperature, const ArrayPlacement& placement);

}  // namespace freevoxels
