#pragma once
// The arguments of the module's functions, some of which may be given without a name. All functions must be called with the GIL held.

#include <pybind11/pybind11.h>

#include <filesystem>
#include <utility>

namespace freevoxels {

/// Fails with ErrorKind::Usage for arguments without a name, of which there are none beyond the first.
void refuseMore(const pybind11::args& more, const char* function, const char* first);

/// The one argument that may be given without its name, None if it is not given, and the keywords without it. Fails with
/// ErrorKind::Usage for more.
std::pair<pybind11::object, pybind11::kwargs> oneOf(const pybind11::args& arguments, const pybind11::kwargs& named, const char* name,
                                                    const char* function);

/// True or False. Fails with ErrorKind::Usage for others.
bool flagOf(const pybind11::object& value, const char* name);

/// The name of a file: text, bytes or a path. Fails with ErrorKind::Usage for others.
std::filesystem::path pathOf(const pybind11::object& file);

}  // namespace freevoxels
