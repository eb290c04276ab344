#include "apps/python/call_arguments.h"

#include <algorithm>

#include "apps/python/numpy_array.h"
#include "apps/python/python_values.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace py = pybind11;
using Json = nlohmann::json;

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

namespace {

bool isName(const py::object& file) {
  return py::isinstance<py::str>(file) || py::isinstance<py::bytes>(file) || py::hasattr(file, "__fspath__");
}

}  // namespace

std::filesystem::path pathOf(const py::object& file) {
  if (!isName(file))
    fail(ErrorKind::Usage, "{} takes the name of a file, not {}", Parameter("file"), typeName(file));
  return jsonOf(py::isinstance<py::bytes>(file) ? py::module_::import("os").attr("fsdecode")(file) : file, "file").get<std::string>();
}

std::vector<std::string> namesOf(const py::object& names, const char* keyword) {
  std::vector<std::string> result;
  const auto add = [&](const py::object& name) {
    if (!isName(name))
      fail(ErrorKind::Usage, "{} takes the name of a file or pattern, or a list of them, not {}", Parameter(keyword), typeName(name));
    result.push_back(pathOf(name).string());
  };
  if (py::isinstance<py::list>(names) || py::isinstance<py::tuple>(names))
    for (const py::handle name : names) add(py::reinterpret_borrow<py::object>(name));
  else if (!names.is_none())
    add(names);
  return result;
}

std::shared_ptr<const Holdout> takeHoldout(py::kwargs& keywords) {
  if (!keywords.contains("holdout")) return nullptr;
  const py::object given = keywords["holdout"];
  if (given.is_none() || isName(given)) return nullptr;
  const ArrayView view = viewOf(given, fmt::format("{}", Parameter("holdout")));
  if (view.dimensions() != 2 || view.elements() == 0 || std::max(view.shape[0], view.shape[1]) > kMaxImageEdge)
    fail(ErrorKind::Input, "{} takes depths of the shape (height, width) of the image, not {}", Parameter("holdout"), view.shapeText());
  Holdout holdout{.size = {int(view.shape[1]), int(view.shape[0])}, .depths = std::vector<float>(std::size_t(view.elements()))};
  copyFloats(view, holdout.depths.data());
  checkHoldout(holdout, fmt::format("{}", Parameter("holdout")));
  py::kwargs others;
  for (const auto& [key, value] : keywords)
    if (keywordText(key) != "holdout") others[key] = value;
  keywords = others;
  return std::make_shared<const Holdout>(std::move(holdout));
}

py::object Wanted::resultOf(Image& image) const {
  const py::object pixels = pixelsOf(image);
  if (byName) return py::make_tuple(pixels, channelsOf(image));
  return channels.depth ? py::make_tuple(pixels, depthOf(image)) : pixels;
}

Wanted wantedOf(const py::object& depth, const py::object& aov) {
  Wanted wanted{.channels = {.depth = flagOf(depth, "depth")}};
  if (aov.is_none()) return wanted;
  if (wanted.channels.depth)
    fail(ErrorKind::Usage, "{} and {} exclude each other: name depth among the channels", Parameter("depth"), Parameter("aov"));
  const Json names = jsonOf(aov, "aov");
  std::string text;
  for (const Json& name : names.is_array() ? names : Json::array({names})) {
    if (!name.is_string()) fail(ErrorKind::Usage, "{} takes names of channels as text, not {}", Parameter("aov"), typeName(aov));
    text += (text.empty() ? "" : ",") + name.get<std::string>();
  }
  return {.channels = readAovs(fmt::format("{}", Parameter("aov")), text), .byName = true};
}

py::object cameraOf(const Json& camera) {
  if (camera.empty()) return py::none();
  py::dict options;
  for (const auto& [name, value] : camera.items()) {
    const py::object numbers = pythonOf(value);
    options[py::str(keywordOf(name))] = value.is_array() ? py::tuple(numbers) : numbers;
  }
  return options;
}

std::vector<std::pair<std::string, double>> timingsOf(const std::vector<StageTime>& times) {
  std::vector<std::pair<std::string, double>> pairs;
  for (const StageTime& time : times) pairs.emplace_back(time.name, time.milliseconds);
  return pairs;
}

}  // namespace freevoxels
