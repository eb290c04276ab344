#pragma once
// Conversions of values between Python and the engine. All functions must be called with the GIL held.

#include <pybind11/pybind11.h>

#include <nlohmann/json.hpp>

#include "engine/core/stages.h"
#include "engine/image/image.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Converts keyword arguments: bools, finite numbers, text, paths, mappings and sequences of them, and objects with tolist() such as
/// NumPy's arrays. None is left out. Fails with ErrorKind::Input for others; the sentence names the keyword.
nlohmann::json jsonOf(const pybind11::kwargs& keywords);
/// Converts the value of one keyword in the same way.
nlohmann::json jsonOf(pybind11::handle value, const std::string& keyword);
/// The inverse, for JSON that was read from a file.
pybind11::object pythonOf(const nlohmann::json& value);
/// Text that may be a file name: bytes that are no UTF-8 become surrogates, as os.fsdecode() has them.
pybind11::str fileNameOf(std::string_view text);
/// The name of a keyword argument. Fails with ErrorKind::Usage for what is no Unicode text.
std::string keywordText(pybind11::handle keyword);
/// The name of an option or key as a keyword: "density_scale" for "density-scale".
std::string keywordOf(std::string_view name);
/// The name of a value's type, for messages.
std::string typeName(pybind11::handle value);

/// Returns a progress function that calls `callback(stage, fraction)` with the GIL, unless it is None, and
/// lets Ctrl-C interrupt the work. An exception of either cancels the work. `callback` must outlive the
/// result.
Progress progressOf(const pybind11::object& callback);
/// Returns a progress function that lets Ctrl-C interrupt work, which may call it often.
Progress watchSignals();

/// Arrays float32 (height, width, 4) and (height, width) that take over the image's memory.
pybind11::object pixelsOf(Image& image);
pybind11::object depthOf(Image& image);
/// The image's depth and channels as a dictionary of arrays float32 (height, width), or (height, width, 3) of vectors, by the names that
/// readAovs has.
pybind11::dict channelsOf(Image& image);

/// The image of two such arrays, of which `depth` may be None. Fails with ErrorKind::Input for other shapes, and for colours that are
/// whole numbers.
Image imageOf(const pybind11::object& pixels, const pybind11::object& depth);
/// Gives an image the depth and channels of such a dictionary. Fails with ErrorKind::Input for other names and shapes.
void addChannels(Image& image, const pybind11::dict& channels);

/// Adds freevoxels.Error and its subclasses, one for each ErrorKind, and translates Error to them, with its parameters.
void addExceptions(pybind11::module_& module);

/// Sends the warnings of a volume to Python's logger "freevoxels".
void warnInPython(const Volume& volume);

/// Sends a sentence with parameters there, as a warning or a remark. Any thread may call it, with the GIL or without.
void tellPython(const std::string& sentence, bool isWarning);

/// Sends messages to Python's logger "freevoxels".
void logToPython();

}  // namespace freevoxels
