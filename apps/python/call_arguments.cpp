#include "apps/python/call_arguments.h"

#include "apps/python/python_values.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace py = pybind11;

void refuseMore(const py::args& more, const char* function, const char* first) {
  if (!more.empty()) fail(ErrorKind::Usage, "{} takes {} without a name, and options by name only: density_scale=40", function, first);
}

std::pair<py::object, py::kwargs> oneOf(const py::args& arguments, const py::kwargs& named, const char* name, const char* function) {
  const bool isNamed = named.contains(name);
  if (arguments.size() + (isNamed ? 1 : 0) > 1)
    fail(ErrorKind::Usage, "{} takes one {}, and options by name: density_scale=40", function, name);
  py::kwargs others;
  for (const auto& [key, value] : named)
    if (keywordText(key) != name) others[key] = value;
  if (!arguments.empty()) return {arguments[0], others};
  return {isNamed ? py::object(named[name]) : py::object(py::none()), others};
}

bool flagOf(const py::object& value, const char* name) {
  if (!py::isinstance<py::bool_>(value)) fail(ErrorKind::Usage, "{} takes True or False, not {}", Parameter(name), typeName(value));
  return value.cast<bool>();
}

std::filesystem::path pathOf(const py::object& file) {
  if (!py::isinstance<py::str>(file) && !py::isinstance<py::bytes>(file) && !py::hasattr(file, "__fspath__"))
    fail(ErrorKind::Usage, "{} takes the name of a file, not {}", Parameter("file"), typeName(file));
  return jsonOf(py::isinstance<py::bytes>(file) ? py::module_::import("os").attr("fsdecode")(file) : file, "file").get<std::string>();
}

}  // namespace freevoxels
