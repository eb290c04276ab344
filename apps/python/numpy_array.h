#pragma once
// NumPy's arrays by the attributes that all versions of NumPy have. pybind11's own view of them (pybind11/numpy.h) reads the structs of
// NumPy 1, in which NumPy 2 keeps other things. All functions must be called with the GIL held.

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace freevoxels {

enum class ElementType { Flag, U8, U16, U32, U64, I8, I16, I32, I64, F16, F32, F64 };

/// An array of numbers, whose data stay where they are for as long as this object exists.
struct ArrayView {
  pybind11::object array;  ///< numpy.ndarray, which keeps the data
  ElementType type{};
  bool isSwapped = false;  ///< whether the bytes of an element are in the reverse of the machine's order
  const char* data = nullptr;
  std::vector<pybind11::ssize_t> shape, strides;  ///< the latter in bytes, of either sign
  /// Flags of the same shape, set where an element of a masked array (numpy.ma) is masked; null of other arrays.
  std::shared_ptr<const ArrayView> mask;

  pybind11::ssize_t dimensions() const { return pybind11::ssize_t(shape.size()); }
  pybind11::ssize_t elements() const;
  std::string typeName() const;
  /// "12 x 14 x 16"
  std::string shapeText() const;
};

/// Views an array, or converts what numpy.asarray() takes. `what` is its name in sentences, such as "the array". Fails with
/// ErrorKind::Input for what is no array, and for elements that are no real numbers of ElementType.
ArrayView viewOf(const pybind11::object& source, std::string_view what);

/// Copies an array of any type to `values`, as 32-bit floats in C order.
void copyFloats(const ArrayView& view, float* values);

/// A float32 array of `shape`, in C order, of memory that `owner` keeps for it.
pybind11::object arrayOf(std::shared_ptr<void> owner, float* values, std::vector<pybind11::ssize_t> shape);

/// Adds the class that keeps the memory of arrays of arrayOf().
void addArrayMemory(pybind11::module_& module);

}  // namespace freevoxels
