#pragma once
// The class Volume of the module. All functions must be called with the GIL held.

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "apps/common/shared_volume.h"

namespace freevoxels {

struct PythonVolume {
  std::shared_ptr<const SharedVolume> volume;
  bool isOfArray = false;

  const Volume& describe() const { return volume->describe(); }
};

/// The name by which a scene refers to the volume besides its own one (nameInMemory). A baked one is read as a whole.
std::string nameOf(const PythonVolume& volume);

/// Volume(array, ...). Fails with ErrorKind::Input for arrays and values that cannot be used, with ErrorKind::Usage for other keywords.
PythonVolume volumeFromArray(const pybind11::args& arguments, const pybind11::kwargs& named);
/// Volume.open(file, ...). Without a file, which is None then, it is that of the scene among the keywords. Fails as openVolume does.
PythonVolume volumeFromFile(const pybind11::object& file, const pybind11::args& more, const pybind11::kwargs& keywords);

/// Whether a keyword says where an array is and what it holds, which files and volumes know themselves.
bool isPlacement(const std::string& keyword);
/// Whether a keyword is one of volumeFromArray.
bool isOfArrays(const std::string& keyword);
/// Fails with ErrorKind::Usage for a placement of `what`, such as "a file".
void refusePlacement(const pybind11::kwargs& keywords, const char* what);

/// The same for a file that is opened, which may have the value that holds no data.
void refuseArrayOptions(const pybind11::kwargs& keywords);

/// Adds the class.
void addVolume(pybind11::module_& module);

}  // namespace freevoxels
