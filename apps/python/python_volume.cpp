#include "apps/python/python_volume.h"

#include <fmt/ranges.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <functional>
#include <glm/gtc/matrix_access.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/common/scene_renderer.h"
#include "apps/python/array_volume.h"
#include "apps/python/call_arguments.h"
#include "apps/python/python_values.h"
#include "engine/core/error.h"
#include "engine/core/nearest_name.h"
#include "engine/core/printable.h"
#include "engine/description/added_volume.h"
#include "engine/volume/volume_of_scalars.h"

namespace freevoxels {

namespace {

namespace py = pybind11;
using Json = nlohmann::json;

constexpr std::array kPlacementKeywords{"spacing", "origin", "transform", "no_data", "temperature"};
/// What arrays have in common with files: their part that is drawn, also in the section "input", labels and channels.
constexpr std::array kReadingKeywords{"clip_box", "clip_plane", "labels", "channel", "channels"};

bool isOfReading(const std::string& keyword) {
  return std::ranges::find(kReadingKeywords, keyword) != kReadingKeywords.end();
}

/// One of these, or the section that has some.
bool saysHowToRead(const std::string& keyword) {
  return keyword == "input" || isOfReading(keyword);
}

/// The `count` numbers of a keyword, or a single one where `orSingle`. Nothing if it is not given.
std::optional<std::vector<double>> numbersOf(const py::kwargs& keywords, const char* name, std::size_t count, const char* form,
                                             bool orSingle = false) {
  if (!keywords.contains(name) || py::object(keywords[name]).is_none()) return std::nullopt;
  std::vector<double> numbers;
  const std::function<void(const Json&)> collect = [&](const Json& value) {
    if (value.is_array())
      for (const Json& one : value) collect(one);
    else if (value.is_number())
      numbers.push_back(value.get<double>());
    else
      fail(ErrorKind::Input, "{} takes {}", Parameter(name), form);
  };
  const Json value = jsonOf(keywords[name], name);
  collect(value);
  if (numbers.size() != count && !(orSingle && value.is_number()))
    fail(ErrorKind::Input, "{} takes {}, not {} number{}", Parameter(name), form, numbers.size(), numbers.size() == 1 ? "" : "s");
  return numbers;
}

glm::dmat4 placementOf(const py::kwargs& keywords) {
  const auto spacing = numbersOf(keywords, "spacing", 3, "one number, or three along (x, y, z)", true);
  const auto origin = numbersOf(keywords, "origin", 3, "three numbers (x, y, z)");
  const auto transform = numbersOf(keywords, "transform", 16, "a matrix of 4 x 4 numbers");
  if (!transform) {
    const auto along = [](const std::vector<double>& n) { return n.size() == 1 ? glm::dvec3(n[0]) : glm::dvec3(n[0], n[1], n[2]); };
    return latticeTransform(spacing ? along(*spacing) : glm::dvec3(1.0), origin ? along(*origin) : glm::dvec3(0.0));
  }
  for (const auto& [other, name] : {std::pair(&spacing, "spacing"), std::pair(&origin, "origin")})
    if (*other) fail(ErrorKind::Usage, "{} and {} exclude each other: keep one of them", Parameter(name), Parameter("transform"));
  glm::dmat4 matrix(1.0);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix[column][row] = (*transform)[std::size_t(4 * row + column)];
  if (glm::row(matrix, 3) != glm::dvec4(0.0, 0.0, 0.0, 1.0))
    fail(ErrorKind::Input, "a {} is affine: its last row is 0, 0, 0, 1", Parameter("transform"));
  return matrix;
}

/// How an array is read, from keywords and a section "input" of them, whose file the array replaces.
SceneDescription readingOf(const py::kwargs& keywords) {
  Json reading = Json::object();
  const Json given = jsonOf(keywords);
  for (const auto& [key, value] : given.items()) {
    const auto keep = [](Json& kept, const std::string& option, const Json& one) {
      if (const std::string name = keywordOf(option); isOfReading(name)) kept[name] = one;
    };
    keep(reading, key, value);
    if (key == "input" && value.is_object())
      for (const auto& [inner, one] : value.items()) keep(reading["input"], inner, one);
  }
  return KeywordOptions({reading}, {"input", "classification"}).scene;
}

}  // namespace

bool isPlacement(const std::string& keyword) {
  return std::ranges::find(kPlacementKeywords, keyword) != kPlacementKeywords.end();
}

bool isOfArrays(const std::string& keyword) {
  return isPlacement(keyword) || saysHowToRead(keyword);
}

void refusePlacement(const py::kwargs& keywords, const char* what) {
  for (const auto& [key, value] : keywords)
    if (const std::string name = keywordText(key); isPlacement(name) && !value.is_none())
      fail(ErrorKind::Usage, "{} is an option of arrays, and {} has its own: leave it out", Parameter(name), what);
}

void refuseArrayOptions(const py::kwargs& keywords) {
  py::kwargs placement;
  for (const auto& [key, value] : keywords)
    if (const std::string name = keywordText(key); name != "no_data" && name != "spacing")  // which files have as well
      placement[key] = value;
  refusePlacement(placement, "a file");
}

std::string nameOf(const PythonVolume& volume) {
  const std::shared_ptr<const VolumeSource> source = volume.volume->source({.isRead = true}, {});
  return nameInMemory(source->whole());
}

PythonVolume volumeFromArray(const py::args& arguments, const py::kwargs& named) {
  const auto [array, keywords] = oneOf(arguments, named, "array", "Volume()");
  std::vector<std::string> known(kPlacementKeywords.begin(), kPlacementKeywords.end());
  known.insert(known.end(), kReadingKeywords.begin(), kReadingKeywords.end());
  py::kwargs ofReading;
  for (const auto& [key, value] : keywords)
    if (const std::string name = keywordText(key); saysHowToRead(name))
      ofReading[key] = value;
    else if (!isPlacement(name))
      fail(ErrorKind::Usage, "a volume of an array has no option {}{}", Parameter(quotedPart(name)),
           suggestion(name, known).empty() ? fmt::format(": it has {}", fmt::join(known, ", ")) : suggestion(name, known));
  const auto of = [&](const char* name) { return keywords.contains(name) ? py::object(keywords[name]) : py::object(py::none()); };
  const SceneDescription reading = readingOf(ofReading);
  Volume volume = reading.input.clip(volumeOfArray(
      array, of("temperature"), {placementOf(keywords), of("no_data"), reading.classification.labels, reading.classification.channels}));
  warnInPython(volume);
  return {std::make_shared<const SharedVolume>(std::move(volume)), true};
}

PythonVolume volumeFromFile(const py::object& file, const py::args& more, const py::kwargs& keywords) {
  refuseMore(more, "Volume.open()", "one file");
  refuseArrayOptions(keywords);
  const Json options = jsonOf(keywords);
  const std::string name = file.is_none() ? "" : pathOf(file).string();
  PythonVolume opened;
  {
    const py::gil_scoped_release withoutGil;
    opened.volume = openVolume(name, options, nullptr, watchSignals());
  }
  warnInPython(opened.describe());
  return opened;
}

void addVolume(py::module_& module) {
  using namespace py::literals;
  const std::string parameters =
      "array, *, spacing=1.0, origin=(0.0, 0.0, 0.0), transform=None, no_data=None, temperature=None, clip_box=None, clip_plane=None, "
      "labels=None, channel=None, input=None";
  const std::string text = fmt::format("Volume({})\n--\n\nA volume in memory, which renderers can share.", parameters);
  const std::string textOfArrays = fmt::format(
      "__init__(self, {})\n--\n\n"
      "Copies an array of real numbers with axes (z, y, x). spacing: world units between voxels, one number or along\n"
      "(x, y, z). origin: where the centre of voxel [0, 0, 0] is. transform: instead of both, a 4x4 affine matrix from\n"
      "(x, y, z, 1) in voxels to the world. NaN, and values equal to no_data in the array's own type, hold no data.\n"
      "temperature: an array of the same shape, for emission. clip_box, clip_plane: the part that is drawn, as for files, alone or\n"
      "in the section input of a scene, whose file the array replaces. labels: the values are labels, all or those of a text such as\n"
      "'1,2=red,7@0.3', which are drawn as solids of their colours. channel: a list such as ['0:green', '1:magenta:10,300:emission'] of\n"
      "the channels of an array with axes (channel, z, y, x).",
      parameters);
  py::class_<PythonVolume>(module, "Volume", text.c_str())
      .def(py::init(&volumeFromArray), textOfArrays.c_str())
      .def_static(
          "open", &volumeFromFile, "file"_a = py::none(),
          "open(file=None, **kwargs)\n--\n\n"
          "Reads an OpenVDB file or a scan, or makes 'procedural:NAME'; without a file the volume of a scene. Options: grid, resolution,\n"
          "raw, series, time_step, spacing, pyramid_level, no_data, and those of a frame, of which emission=True, temperature_grid and "
          "albedo_grid add "
          "grids to read. Of a baked\n"
          "volume (.fvx) a level of detail is read when a frame needs it.")
      .def("__repr__",
           [](const PythonVolume& v) {
             const glm::ivec3 size = v.describe().dimensions;
             return fmt::format("<freevoxels.Volume of {}: {} x {} x {} voxels along z, y, x>", printable(v.describe().source), size.z,
                                size.y, size.x);
           })
      .def_property_readonly(
          "shape",
          [](const PythonVolume& v) {
            const glm::ivec3 size = v.describe().dimensions;
            return py::make_tuple(size.z, size.y, size.x);
          },
          "Voxels along z, y and x.")
      .def_property_readonly(
          "range", [](const PythonVolume& v) { return std::pair(v.describe().minimum, v.describe().maximum); },
          "The least and the largest value of the voxels that hold data.")
      .def_property_readonly(
          "active_voxels", [](const PythonVolume& v) { return v.describe().activeVoxels; }, "How many voxels hold data.")
      .def_property_readonly(
          "origin",
          [](const PythonVolume& v) {
            const glm::dvec3 origin(v.describe().indexToWorld[3]);
            return py::make_tuple(origin.x, origin.y, origin.z);
          },
          "World position (x, y, z) of the centre of voxel [0, 0, 0].")
      .def_property_readonly(
          "source", [](const PythonVolume& v) { return fileNameOf(v.describe().source); }, "File and grid, for messages.");
}

}  // namespace freevoxels
