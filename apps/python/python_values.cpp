#include "apps/python/python_values.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/core/error.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

namespace {

namespace py = pybind11;
using Json = nlohmann::json;

template <typename Value>
py::array adopt(std::vector<Value>& values, std::vector<py::ssize_t> shape) {
  auto owned = std::make_unique<std::vector<Value>>(std::move(values));
  void* const data = owned->data();
  const py::capsule owner(owned.release(), [](void* vector) { delete static_cast<std::vector<Value>*>(vector); });
  return py::array(py::dtype::of<float>(), std::move(shape), data, owner);
}

/// Needs no lock, because the GIL lets only one message through at a time.
class PythonLog : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const py::gil_scoped_acquire withGil;
    const char* const level = message.level >= spdlog::level::err    ? "error"
                              : message.level == spdlog::level::warn ? "warning"
                              : message.level == spdlog::level::info ? "info"
                                                                     : "debug";
    const py::object logger = py::module_::import("logging").attr("getLogger")("freevoxels");
    logger.attr(level)("%s", std::string(message.payload.data(), message.payload.size()));
  }
  void flush_() override {}
};

struct ExceptionClass {
  ErrorKind kind;
  const char* name;
  PyObject* alsoBase;  ///< a standard class of Python that callers may expect
  const char* meaning;
};

/// The exception classes by ErrorKind, owned by the module. Other kinds are freevoxels.Error itself.
std::array<PyObject*, 8> exceptionClasses{};

std::string keyword(std::string_view parameter) {
  std::string name(parameter);
  std::ranges::replace(name, '-', '_');
  return name;
}

/// The text with its parameters as keyword arguments: 'memory_limit', draw='splats'.
std::string withKeywords(std::string_view text) {
  return spelled(text, [](std::string_view name, std::string_view value) {
    return value.empty() ? fmt::format("'{}'", keyword(name)) : fmt::format("{}='{}'", keyword(name), value);
  });
}

/// Sets Python's current exception.
void raise(const Error& error) {
  py::list parameters;
  for (const std::string& parameter : error.parameters()) parameters.append(keyword(parameter));
  const py::handle type = exceptionClasses[std::size_t(error.kind())];
  const py::object exception = type(withKeywords(error.text()));
  exception.attr("parameters") = py::tuple(parameters);
  PyErr_SetObject(type.ptr(), exception.ptr());
}

}  // namespace

Json jsonOf(py::handle value, const std::string& name) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::int_>(value)) return value.cast<std::int64_t>();
  if (py::isinstance<py::float_>(value)) return value.cast<double>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::hasattr(value, "__fspath__")) return py::str(value.attr("__fspath__")()).cast<std::string>();
  if (py::hasattr(value, "tolist")) return jsonOf(value.attr("tolist")(), name);
  if (py::isinstance<py::dict>(value)) {
    Json object = Json::object();
    for (const auto& [key, one] : py::cast<py::dict>(value))
      if (!one.is_none()) object[py::str(key).cast<std::string>()] = jsonOf(one, name);
    return object;
  }
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    Json list = Json::array();
    for (const py::handle one : value) list.push_back(jsonOf(one, name));
    return list;
  }
  fail(ErrorKind::Input, "'{}' takes numbers, text, lists and dictionaries, not {}", name,
       py::str(py::type::of(value).attr("__name__")).cast<std::string>());
}

py::object pythonOf(const Json& value) {
  if (value.is_boolean()) return py::bool_(value.get<bool>());
  if (value.is_number_integer()) return py::int_(value.get<std::int64_t>());
  if (value.is_number()) return py::float_(value.get<double>());
  if (value.is_string()) return py::str(value.get<std::string>());
  if (value.is_object()) {
    py::dict object;
    for (const auto& [key, one] : value.items()) object[py::str(key)] = pythonOf(one);
    return object;
  }
  py::list list;
  for (const Json& one : value) list.append(pythonOf(one));
  return list;
}

Json jsonOf(const py::kwargs& keywords) {
  Json object = Json::object();
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    if (!value.is_none()) object[name] = jsonOf(value, name);
  }
  return object;
}

Progress progressOf(const py::object& callback) {
  return [function = py::handle(callback)](std::string_view stage, double fraction) {
    const py::gil_scoped_acquire withGil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!function.is_none()) function(py::str(stage.data(), stage.size()), fraction);
  };
}

py::array pixelsOf(Image& image) {
  return adopt(image.pixels, {image.size.y, image.size.x, 4});
}

py::array depthOf(Image& image) {
  return adopt(image.depth, {image.size.y, image.size.x});
}

Image imageOf(const py::array& pixels, const std::optional<py::array>& depth) {
  using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
  if (pixels.ndim() != 3 || pixels.shape(2) != 4 || pixels.size() == 0)
    fail(ErrorKind::Input, "an image to save has the shape (height, width, 4): linear red, green, blue and alpha");
  const Floats colors(pixels);
  Image image{.size = {colors.shape(1), colors.shape(0)}};
  image.pixels.resize(std::size_t(colors.size()) / 4);
  std::memcpy(image.pixels.data(), colors.data(), std::size_t(colors.nbytes()));
  if (!depth) return image;
  const Floats distances(*depth);
  if (distances.ndim() != 2 || distances.shape(0) != image.size.y || distances.shape(1) != image.size.x)
    fail(ErrorKind::Input, "the depth to save has the shape (height, width) of its image");
  image.depth.assign(distances.data(), distances.data() + distances.size());
  return image;
}

void addExceptions(py::module_& module) {
  const auto add = [&](const char* name, const char* meaning, const py::tuple& bases) {
    PyObject* const type = PyErr_NewExceptionWithDoc(fmt::format("freevoxels.{}", name).c_str(), meaning, bases.ptr(), nullptr);
    if (type == nullptr) throw py::error_already_set();
    module.add_object(name, py::reinterpret_borrow<py::object>(type));
    return type;
  };
  PyObject* const base = add("Error", "What went wrong, and what mends it: the base of all exceptions of this module.",
                             py::make_tuple(py::handle(PyExc_Exception)));
  exceptionClasses.fill(base);
  const std::array classes{
      ExceptionClass{ErrorKind::Usage, "UsageError", PyExc_ValueError, "An option does not exist or contradicts others."},
      ExceptionClass{ErrorKind::Input, "InputError", PyExc_ValueError, "An array, file or value cannot be used."},
      ExceptionClass{ErrorKind::Output, "OutputError", PyExc_OSError, "A file cannot be written."},
      ExceptionClass{ErrorKind::Device, "DeviceError", PyExc_RuntimeError, "There is no such Vulkan device, or it failed."},
      ExceptionClass{ErrorKind::OutOfMemory, "OutOfMemoryError", PyExc_MemoryError, "The memory of device or machine is full."}};
  for (const ExceptionClass& one : classes)
    exceptionClasses[std::size_t(one.kind)] =
        add(one.name, one.meaning, py::make_tuple(py::handle(base), py::handle(one.alsoBase)));
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      raise(error);
    }
  });
}

void warnInPython(const Volume& volume) {
  for (const std::string& warning : warningsOf(volume, false)) spdlog::warn("{}", withKeywords(warning));
}

void logToPython() {
  auto logger = std::make_shared<spdlog::logger>("freevoxels", std::make_shared<PythonLog>());
  logger->set_level(spdlog::level::debug);
  spdlog::set_default_logger(std::move(logger));
}

}  // namespace freevoxels
