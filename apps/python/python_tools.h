#pragma once
// The module's functions beside drawing: devices(), presets(), info(), bake(), convert() and merge().

#include <pybind11/pybind11.h>

namespace freevoxels {

/// Adds them. Volume must have been added.
void addTools(pybind11::module_& module);

}  // namespace freevoxels
