#pragma once
// The class Renderer of the module, and its function render().

#include <pybind11/pybind11.h>

namespace freevoxels {

/// Adds them. Volume must have been added.
void addRenderer(pybind11::module_& module);

}  // namespace freevoxels
