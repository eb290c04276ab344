#pragma once
// Values that pass between Python and the engine. All functions are to be called with the GIL held.

#include <pybind11/numpy.h>

#include <nlohmann/json.hpp>

#include "engine/core/stages.h"
#include "engine/image/image.h"

namespace freevoxels {

/// bool, int, float, str, path, dict, list, tuple, and whatever has tolist() as numpy's arrays and numbers have. `name` is
/// what the sentence calls the value that refuses it: ExitCode::Input.
nlohmann::json jsonOf(pybind11::handle value, const std::string& name);
/// The same of keyword arguments; None is left out.
nlohmann::json jsonOf(const pybind11::kwargs& keywords);

/// Calls `callback(stage, fraction)`, unless it is None, with the GIL, and lets Ctrl-C interrupt the work. An exception of
/// either abandons the work that reports. `callback` must outlive the result.
Progress progressOf(const pybind11::object& callback);

/// float32 (height, width, 4), and (height, width), which take the image's memory over.
pybind11::array pixelsOf(Image& image);
pybind11::array depthOf(Image& image);

/// The image of two such arrays. ExitCode::Input for other shapes.
Image imageOf(const pybind11::array& pixels, const std::optional<pybind11::array>& depth);

/// Makes freevoxels.Error and the classes derived from it, one for each ExitCode of an error, and translates Error to them.
void addExceptions(pybind11::module_& module);

/// Sends messages to Python's logger "freevoxels".
void logToPython();

}  // namespace freevoxels
