#include "apps/python/numpy_array.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "apps/python/python_values.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

namespace py = pybind11;
using namespace py::literals;

/// The memory of an array. NumPy reaches it by the buffer protocol, and its array holds a reference.
struct ArrayMemory {
  std::shared_ptr<void> owner;
  float* values;
  std::vector<py::ssize_t> shape;
};

py::module_ numpy() {
  return py::module_::import("numpy");
}

/// The type of the elements. Types are compared as a whole, since others have the same kind and size: bfloat16 that of float16.
std::optional<ElementType> typeOf(const py::object& dtype) {
  constexpr std::array<const char*, 12> kCodes{"?", "u1", "u2", "u4", "u8", "i1", "i2", "i4", "i8", "f2", "f4", "f8"};
  const std::string kind = py::str(dtype.attr("kind"));
  if (kind.size() != 1 || std::string_view("buif").find(kind) == std::string_view::npos) return std::nullopt;
  const py::object native = dtype.attr("newbyteorder")("=");
  for (std::size_t type = 0; type < kCodes.size(); ++type)
    if (native.equal(numpy().attr("dtype")(kCodes[type]))) return ElementType(type);
  return std::nullopt;
}

py::object asArray(const py::object& source, std::string_view what) {
  if (py::isinstance<py::str>(source) || py::hasattr(source, "__fspath__"))
    fail(ErrorKind::Input, "{} is the name of a file: open it with Volume.open(), or load it into an array", what);
  try {
    return numpy().attr("asarray")(source);
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
    fail(ErrorKind::Input, "{} is of the type {}, of which NumPy can make no array of numbers", what, typeName(source));
  }
}

std::vector<py::ssize_t> sizesOf(const py::object& tuple) {
  return tuple.cast<std::vector<py::ssize_t>>();
}

}  // namespace

py::ssize_t ArrayView::elements() const {
  return std::accumulate(shape.begin(), shape.end(), py::ssize_t(1), std::multiplies());
}

std::string ArrayView::typeName() const {
  return py::str(array.attr("dtype").attr("name"));
}

std::string ArrayView::shapeText() const {
  std::string text;
  for (const py::ssize_t size : shape) text += fmt::format("{}{}", text.empty() ? "" : " x ", size);
  return text;
}

namespace {

/// Null where nothing is masked.
std::shared_ptr<const ArrayView> maskOf(const py::object& source, std::string_view what) {
  const py::module_ masked = numpy().attr("ma");
  if (!py::isinstance(source, masked.attr("MaskedArray")) || !masked.attr("is_masked")(source).cast<bool>()) return nullptr;
  return std::make_shared<const ArrayView>(viewOf(masked.attr("getmaskarray")(source), what));
}

}  // namespace

ArrayView viewOf(const py::object& source, std::string_view what) {
  const py::object array = asArray(source, what), dtype = array.attr("dtype");
  const std::optional<ElementType> type = typeOf(dtype);
  if (!type && std::string(py::str(dtype.attr("kind"))) == "O")
    fail(ErrorKind::Input, "{} is of the type {} and holds no numbers: give it as an array of numbers", what, freevoxels::typeName(source));
  if (!type)
    fail(ErrorKind::Input, "arrays of {} cannot be used: convert it with array.astype('float32')",
         std::string(py::str(py::getattr(dtype, "name", py::str(dtype)))));
  const auto address = array.attr("__array_interface__")["data"].cast<py::tuple>()[0].cast<std::uintptr_t>();
  return {.array = array,
          .type = *type,
          .isSwapped = !dtype.attr("isnative").cast<bool>(),
          .data = reinterpret_cast<const char*>(address),
          .shape = sizesOf(array.attr("shape")),
          .strides = sizesOf(array.attr("strides")),
          .mask = maskOf(source, what)};
}

void copyFloats(const ArrayView& view, float* values) {
  if (view.mask) fail(ErrorKind::Input, "an array to save has a mask, which images have not: fill it with array.filled(0)");
  const ArrayView floats = viewOf(numpy().attr("ascontiguousarray")(view.array, "dtype"_a = "=f4"), "the array");
  std::memcpy(values, floats.data, std::size_t(floats.elements()) * sizeof(float));
}

py::object arrayOf(std::shared_ptr<void> owner, float* values, std::vector<py::ssize_t> shape) {
  return numpy().attr("asarray")(py::cast(std::make_unique<ArrayMemory>(ArrayMemory{std::move(owner), values, std::move(shape)})));
}

void addArrayMemory(py::module_& module) {
  py::class_<ArrayMemory>(module, "_ArrayMemory", py::buffer_protocol()).def_buffer([](ArrayMemory& memory) {
    return py::buffer_info(memory.values, memory.shape, py::detail::c_strides(memory.shape, sizeof(float)));
  });
}

}  // namespace freevoxels
