#pragma once
// The class Sequence of the module, and its function render_sequence().

#include <pybind11/pybind11.h>

namespace freevoxels {

/// Adds them.
void addSequence(pybind11::module_& module);

}  // namespace freevoxels
