#include "apps/python/python_values.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "apps/python/numpy_array.h"
#include "apps/python/python_volume.h"
#include "engine/core/error.h"
#include "engine/core/nearest_name.h"
#include "engine/core/printable.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

namespace {

namespace py = pybind11;
using Json = nlohmann::json;

template <typename Value>
py::object adopt(std::vector<Value>& values, std::vector<py::ssize_t> shape) {
  auto owned = std::make_shared<std::vector<Value>>(std::move(values));
  auto* const data = reinterpret_cast<float*>(owned->data());
  return arrayOf(std::move(owned), data, std::move(shape));
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
    logger.attr(level)("%s", printable({message.payload.data(), message.payload.size()}));
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

/// The text with its parameters as keyword arguments: 'memory_limit', draw='splats'.
std::string withKeywords(std::string_view text) {
  return spelled(text, [](std::string_view name, std::string_view value) {
    return value.empty() ? fmt::format("'{}'", keywordOf(name)) : fmt::format("{}='{}'", keywordOf(name), value);
  });
}

/// Whether a value is of a class of a module, or registered as one.
bool isOf(py::handle value, const char* module, const char* name) {
  return py::isinstance(value, py::module_::import(module).attr(name));
}

/// Reads the value of one keyword. Values are others' objects, which may be anything and call anything.
class ValueReader {
 public:
  explicit ValueReader(std::string keyword) : keyword_(std::move(keyword)) {}
  /// `place` is the keyword, with the keys of dictionaries that lead to the value; `depth` counts what is around it.
  Json read(py::handle value, const std::string& place, int depth) const;

 private:
  static constexpr int kDeepest = 16;
  static Json readWhole(py::handle value, const std::string& place);
  static Json readReal(py::handle value, const std::string& place);
  static std::string readText(const py::object& text, const std::string& place);
  Json readMapping(py::handle value, const std::string& place, int depth) const;

  const std::string keyword_;
};

Json ValueReader::readWhole(py::handle value, const std::string& place) {
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(value.ptr(), &overflow);
  if (overflow != 0) fail(ErrorKind::Input, "{} takes no whole number of more than 64 bits: write it as a float", Parameter(place));
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  return std::int64_t(number);
}

Json ValueReader::readReal(py::handle value, const std::string& place) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  if (!std::isfinite(number)) fail(ErrorKind::Input, "{} takes finite numbers, not {}", Parameter(place), number);
  return number;
}

/// Text as UTF-8; of file names that are not, which Python has as surrogates or as bytes, the bytes.
std::string ValueReader::readText(const py::object& text, const std::string& place) {
  if (PyBytes_Check(text.ptr()) != 0) return py::reinterpret_borrow<py::bytes>(text);
  Py_ssize_t size = 0;
  if (const char* const characters = PyUnicode_AsUTF8AndSize(text.ptr(), &size); characters != nullptr) return {characters, std::size_t(size)};
  PyErr_Clear();
  const auto bytes = py::reinterpret_steal<py::object>(PyUnicode_EncodeFSDefault(text.ptr()));
  if (bytes) return py::reinterpret_borrow<py::bytes>(bytes);
  PyErr_Clear();
  fail(ErrorKind::Input, "{} is text with characters that Unicode does not have", Parameter(place));
}

Json ValueReader::readMapping(py::handle value, const std::string& place, int depth) const {
  Json object = Json::object();
  const py::list items(value.attr("items")());  // of its own, as what is read may change the mapping
  for (const py::handle item : items) {
    const auto pair = py::reinterpret_borrow<py::tuple>(item);
    const py::object key = pair[0], one = pair[1];
    if (!py::isinstance<py::str>(key)) fail(ErrorKind::Input, "{} takes keys that are text, not {}", Parameter(place), typeName(key));
    const std::string name = readText(key, place);
    if (!one.is_none()) object[name] = read(one, place + "." + name, depth + 1);
  }
  return object;
}

Json ValueReader::read(py::handle value, const std::string& place, int depth) const {
  if (depth > kDeepest)
    fail(ErrorKind::Input, "{} holds something that contains itself, or is nested more than {} deep", Parameter(keyword_), kDeepest);
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::int_>(value)) return readWhole(value, place);
  if (py::isinstance<py::float_>(value) || isOf(value, "numbers", "Real")) {
    if (isOf(value, "numbers", "Integral")) return readWhole(py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr())), place);
    return readReal(value, place);
  }
  if (py::isinstance<PythonVolume>(value)) return nameOf(value.cast<const PythonVolume&>());
  if (py::isinstance<py::str>(value)) return readText(py::reinterpret_borrow<py::object>(value), place);
  if (py::hasattr(value, "__fspath__")) {
    const auto path = py::reinterpret_steal<py::object>(PyOS_FSPath(value.ptr()));
    if (!path) throw py::error_already_set();
    return readText(path, place);
  }
  if (py::hasattr(value, "tolist")) return read(value.attr("tolist")(), place, depth + 1);
  if (isOf(value, "collections.abc", "Mapping")) return readMapping(value, place, depth);
  const bool isBytes = PyBytes_Check(value.ptr()) != 0 || PyByteArray_Check(value.ptr()) != 0;
  if (!isBytes && isOf(value, "collections.abc", "Sequence")) {
    Json list = Json::array();
    for (const py::handle one : value) list.push_back(read(one, place, depth + 1));
    return list;
  }
  fail(ErrorKind::Input, "{} takes numbers, text, lists and dictionaries, not {}", Parameter(place), typeName(value));
}

/// Sets Python's current exception.
void raise(const Error& error) {
  py::list parameters;
  for (const std::string& parameter : error.parameters()) parameters.append(keywordOf(parameter));
  const py::handle type = exceptionClasses[std::size_t(error.kind())];
  const py::object exception = type(printable(withKeywords(error.text())));
  exception.attr("parameters") = py::tuple(parameters);
  PyErr_SetObject(type.ptr(), exception.ptr());
}

}  // namespace

std::string keywordText(py::handle keyword) {
  Py_ssize_t size = 0;
  if (const char* const characters = PyUnicode_AsUTF8AndSize(keyword.ptr(), &size); characters != nullptr) return {characters, std::size_t(size)};
  PyErr_Clear();
  fail(ErrorKind::Usage, "there is no option whose name has characters that Unicode does not have");
}

std::string keywordOf(std::string_view name) {
  std::string keyword(name);
  std::ranges::replace(keyword, '-', '_');
  return keyword;
}

std::string typeName(py::handle value) {
  return value.is_none() ? "None" : py::str(py::type::of(value).attr("__name__")).cast<std::string>();
}

py::str fileNameOf(std::string_view text) {
  PyObject* const decoded = PyUnicode_DecodeUTF8(text.data(), py::ssize_t(text.size()), "surrogateescape");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

py::object pythonOf(const Json& value) {
  if (value.is_boolean()) return py::bool_(value.get<bool>());
  if (value.is_number_unsigned()) return py::int_(value.get<std::uint64_t>());
  if (value.is_number_integer()) return py::int_(value.get<std::int64_t>());
  if (value.is_number()) return py::float_(value.get<double>());
  if (value.is_string()) return fileNameOf(value.get<std::string>());
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
    const std::string name = keywordText(key);
    if (!value.is_none()) object[name] = ValueReader(name).read(value, name, 0);
  }
  return object;
}

Json jsonOf(py::handle value, const std::string& keyword) {
  return ValueReader(keyword).read(value, keyword, 0);
}

Progress progressOf(const py::object& callback) {
  if (!callback.is_none() && PyCallable_Check(callback.ptr()) == 0)
    fail(ErrorKind::Usage, "{} takes a function of a stage and a fraction, not {}", Parameter("progress"), typeName(callback));
  return [function = py::handle(callback)](std::string_view stage, double fraction) {
    const py::gil_scoped_acquire withGil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!function.is_none()) function(py::str(stage.data(), stage.size()), fraction);
  };
}

Progress watchSignals() {
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kInterval{50};  // other threads may hold the GIL for 5 ms each time
  return [next = Clock::now()](std::string_view, double) mutable {
    if (Clock::now() < next) return;
    const py::gil_scoped_acquire withGil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    next = Clock::now() + kInterval;
  };
}

py::object pixelsOf(Image& image) {
  return adopt(image.pixels, {image.size.y, image.size.x, 4});
}

py::object depthOf(Image& image) {
  return adopt(image.depth, {image.size.y, image.size.x});
}

namespace {

/// Channels of an .exr that are one array: by the name that readAovs has, and those of its components.
struct ChannelArray {
  std::string word;
  std::vector<std::string> channels;
};

const std::vector<ChannelArray>& channelArrays() {
  static const std::vector<ChannelArray> arrays{
      {"position", {"P.X", "P.Y", "P.Z"}}, {"normal", {"N.X", "N.Y", "N.Z"}}, {"transmittance", {"transmittance.Y"}}};
  return arrays;
}

/// A layer of a light or a channel.
ChannelArray layerArray(const std::string& name) {
  return {name, {name + ".R", name + ".G", name + ".B"}};
}

/// The values of `array`, which must have the image's height and width, and `components` a pixel if that is not 1.
std::vector<float> pixelValues(const ArrayView& array, glm::ivec2 size, std::size_t components, const std::string& what) {
  const std::vector<py::ssize_t> scalar{size.y, size.x}, vector{size.y, size.x, py::ssize_t(components)};
  if (array.shape != (components == 1 ? scalar : vector))
    fail(ErrorKind::Input, "{} to save has the shape (height, width{}) of its image", what, components == 1 ? "" : fmt::format(", {}", components));
  std::vector<float> values(std::size_t(array.elements()));
  copyFloats(array, values.data());
  return values;
}

}  // namespace

py::dict channelsOf(Image& image) {
  py::dict arrays;
  const std::vector<py::ssize_t> scalar{image.size.y, image.size.x};
  if (!image.depth.empty()) arrays["depth"] = depthOf(image);
  std::vector<ChannelArray> known = channelArrays();
  for (const auto& [name, values] : image.channels)  // layers of lights and channels
    if (name.ends_with(".R")) known.push_back(layerArray(name.substr(0, name.size() - 2)));
  for (const ChannelArray& one : known) {
    const std::size_t components = one.channels.size();
    if (!image.channels.contains(one.channels.front())) continue;
    if (components == 1) {
      arrays[py::str(one.word)] = adopt(image.channels.at(one.channels.front()), scalar);
      continue;
    }
    std::vector<float> values(components * image.channels.at(one.channels.front()).size());
    for (std::size_t c = 0; c < components; ++c) {
      const std::vector<float>& channel = image.channels.at(one.channels[c]);
      FV_CHECK_EQ(components * channel.size(), values.size());
      for (std::size_t i = 0; i < channel.size(); ++i) values[components * i + c] = channel[i];
    }
    arrays[py::str(one.word)] = adopt(values, {image.size.y, image.size.x, py::ssize_t(components)});
  }
  return arrays;
}

void addChannels(Image& image, const py::dict& channels) {
  for (const auto& [key, value] : channels) {
    const std::string word = keywordText(py::str(key)), what = fmt::format("{}", Parameter("aov." + word));
    const ArrayView array = viewOf(py::reinterpret_borrow<py::object>(value), what);
    if (word == "depth") {
      if (!image.depth.empty()) fail(ErrorKind::Usage, "{} is given twice: leave out {}", Parameter("depth"), Parameter("aov." + word));
      image.depth = pixelValues(array, image.size, 1, what);
      continue;
    }
    const auto found = std::ranges::find(channelArrays(), word, &ChannelArray::word);
    // Layers have any name, but none that is a letter from another channel's.
    const auto isNear = [&](const ChannelArray& known) { return editDistance(word, known.word) == 1; };
    const bool isSlip = word.empty() || editDistance(word, "depth") == 1 || std::ranges::any_of(channelArrays(), isNear);
    if (found == channelArrays().end() && isSlip)
      fail(ErrorKind::Usage, "{} takes depth, position, normal, transmittance and layers of lights and channels, not '{}'",
           Parameter("aov"), word);
    const ChannelArray named = found != channelArrays().end() ? *found : layerArray(word);
    const std::size_t components = named.channels.size();
    const std::vector<float> values = pixelValues(array, image.size, components, what);
    for (std::size_t i = 0; i < values.size(); ++i) image.channels[named.channels[i % components]].push_back(values[i]);
  }
}

Image imageOf(const py::object& pixels, const py::object& depth) {
  const ArrayView colors = viewOf(pixels, "the image");
  if (colors.dimensions() != 3 || colors.shape[2] != 4 || colors.elements() == 0)
    fail(ErrorKind::Input, "an image to save has the shape (height, width, 4): linear red, green, blue and alpha");
  if (colors.type < ElementType::F16)
    fail(ErrorKind::Input, "an image to save has linear colours as floats, 1 is white, and not {}: give the array that render() returned",
         colors.typeName());
  Image image{.size = {colors.shape[1], colors.shape[0]}};
  image.pixels.resize(std::size_t(colors.elements()) / 4);
  copyFloats(colors, &image.pixels.front().x);
  if (depth.is_none()) return image;
  image.depth = pixelValues(viewOf(depth, fmt::format("{}", Parameter("depth"))), image.size, 1, "the depth");
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

void tellPython(const std::string& sentence, bool isWarning) {
  spdlog::log(isWarning ? spdlog::level::warn : spdlog::level::info, "{}", withKeywords(sentence));
}

void warnInPython(const Volume& volume) {
  for (const std::string& warning : warningsOf(volume, false)) tellPython(warning, true);
  if (const std::string remarks = remarksOf(volume); !remarks.empty()) tellPython(remarks, false);
}

void logToPython() {
  auto logger = std::make_shared<spdlog::logger>("freevoxels", std::make_shared<PythonLog>());
  logger->set_level(spdlog::level::debug);
  spdlog::set_default_logger(std::move(logger));
}

}  // namespace freevoxels
