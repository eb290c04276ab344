// The Python module `freevoxels`: arrays and files in, images as arrays out.

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <glm/gtc/matrix_access.hpp>
#include <memory>
#include <optional>

#include "apps/freevoxels/program.h"
#include "apps/library/scene_renderer.h"
#include "apps/python/array_volume.h"
#include "apps/python/python_values.h"
#include "engine/core/error.h"
#include "engine/description/scene_fields.h"
#include "engine/volume/volume_of_scalars.h"

namespace freevoxels {

namespace {

namespace py = pybind11;
using Json = nlohmann::json;
using Triple = std::array<double, 3>;
using Matrix = std::array<std::array<double, 4>, 4>;

struct PythonVolume {
  std::shared_ptr<const SharedVolume> volume;

  const Volume& describe() const { return volume->describe(); }
};

glm::dmat4 placementOf(const std::variant<double, Triple>& spacing, const Triple& origin, const std::optional<Matrix>& transform) {
  if (!transform) {
    const bool isCube = std::holds_alternative<double>(spacing);
    const Triple steps = isCube ? Triple{std::get<double>(spacing), std::get<double>(spacing), std::get<double>(spacing)}
                                : std::get<Triple>(spacing);
    return latticeTransform({steps[0], steps[1], steps[2]}, {origin[0], origin[1], origin[2]});
  }
  glm::dmat4 matrix(1.0);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix[column][row] = (*transform)[std::size_t(row)][std::size_t(column)];
  if (glm::row(matrix, 3) != glm::dvec4(0.0, 0.0, 0.0, 1.0))
    fail(ErrorKind::Input, "a transform is affine: its last row is 0, 0, 0, 1");
  return matrix;
}

PythonVolume volumeFromArray(const py::array& array, const std::variant<double, Triple>& spacing, const Triple& origin,
                             const std::optional<Matrix>& transform, const py::object& noData,
                             const std::optional<py::array>& temperature) {
  const ArrayPlacement place{placementOf(spacing, origin, transform), noData};
  Volume volume = volumeOfArray(array, temperature, place);
  warnInPython(volume);
  return {std::make_shared<const SharedVolume>(std::move(volume))};
}

PythonVolume volumeFromFile(const std::optional<std::filesystem::path>& file, const py::kwargs& keywords) {
  const Json options = jsonOf(keywords);
  PythonVolume opened;
  {
    const py::gil_scoped_release withoutGil;
    opened.volume = openVolume(file ? file->string() : "", options);
  }
  warnInPython(opened.describe());
  return opened;
}

std::unique_ptr<SceneRenderer> makeRenderer(const PythonVolume& volume, const py::kwargs& keywords) {
  Json options = jsonOf(keywords);
  const py::gil_scoped_release withoutGil;  // which another thread may need that opens the device
  return std::make_unique<SceneRenderer>(volume.volume, std::move(options));
}

py::object render(SceneRenderer& renderer, const py::object& progress, bool depth, const py::kwargs& keywords) {
  const Json options = jsonOf(keywords);
  const Progress report = progressOf(progress);
  Image image;
  {
    const py::gil_scoped_release withoutGil;
    image = renderer.render(*renderer.read(options), depth, report);
  }
  if (!depth) return pixelsOf(image);
  return py::make_tuple(pixelsOf(image), depthOf(image));
}

std::vector<std::pair<std::string, double>> timingsOf(const SceneRenderer& renderer) {
  std::vector<std::pair<std::string, double>> pairs;
  const py::gil_scoped_release withoutGil;
  for (const StageTime& time : renderer.timings()) pairs.emplace_back(time.name, time.milliseconds);
  return pairs;
}

void save(const std::filesystem::path& file, const py::array& image, const std::optional<py::array>& depth,
          const py::kwargs& keywords) {
  const Json options = jsonOf(keywords);
  const Image pixels = imageOf(image, depth);
  const py::gil_scoped_release withoutGil;
  saveImage(file.string(), pixels, options);
}

py::object loadSceneFile(const std::filesystem::path& file) {
  return pythonOf(loadScene(file));
}

void saveSceneFile(const std::filesystem::path& file, const py::kwargs& keywords) {
  saveScene(file, jsonOf(keywords));
}

constexpr const char* kModuleText =
    "Renders volumes with shadows, on a GPU or on the CPU.\n\n"
    "    import freevoxels\n"
    "    image = freevoxels.render(array, spacing=(1, 1, 2.5), size=(800, 600))\n"
    "    freevoxels.save('image.png', image)\n\n"
    "An array has axes (z, y, x); spacing, origin and every other position are (x, y, z). Options are those of\n"
    "'freevoxels render --help', with _ in place of -: density_scale=40, orbit=(35, 25), light='direction=1,1,1',\n"
    "transfer_function={...} or 'file.json', camera={'orbit': (35, 25), 'fov': 30}. A scene file is such keywords, too:\n"
    "render(**load_scene('scene.json'), size=(800, 600)); what is given beside it wins. Errors are freevoxels.Error, whose\n"
    "parameters are the keywords that the sentence names.\n"
    "Remarks and warnings go to the logger 'freevoxels' of the module logging.";

void addVolume(py::module_& module) {
  using namespace py::literals;
  py::class_<PythonVolume>(module, "Volume", "A volume in memory, which renderers can share.")
      .def(py::init(&volumeFromArray), "array"_a, py::kw_only(), "spacing"_a = 1.0, "origin"_a = Triple{},
           "transform"_a = py::none(), "no_data"_a = py::none(), "temperature"_a = py::none(),
           "Copies an array of real numbers with axes (z, y, x). spacing: world units between voxels, one number or along\n"
           "(x, y, z). origin: where the centre of voxel [0, 0, 0] is. transform: instead of both, a 4x4 affine matrix from\n"
           "(x, y, z, 1) in voxels to the world. NaN, and values equal to no_data in the array's own type, hold no data.\n"
           "temperature: an array of the same shape, for emission.")
      .def_static("open", &volumeFromFile, "file"_a = py::none(),
                  "Reads an OpenVDB file, or makes 'procedural:NAME'; without a file the volume of a scene. Options: grid, resolution, and those of a frame, of which\n"
                  "emission=True, temperature_grid and albedo_grid add grids to read. Of a baked volume (.fvx) a level of detail is read\n"
                  "when a frame needs it.")
      .def_property_readonly("shape", [](const PythonVolume& v) {
        const glm::ivec3 size = v.describe().dimensions;
        return py::make_tuple(size.z, size.y, size.x);
      }, "Voxels along z, y and x.")
      .def_property_readonly("range", [](const PythonVolume& v) { return std::pair(v.describe().minimum, v.describe().maximum); },
                             "The least and the largest value of the voxels that hold data.")
      .def_property_readonly("active_voxels", [](const PythonVolume& v) { return v.describe().activeVoxels; },
                             "How many voxels hold data.")
      .def_property_readonly("origin", [](const PythonVolume& v) {
        const glm::dvec3 origin(v.describe().indexToWorld[3]);
        return py::make_tuple(origin.x, origin.y, origin.z);
      }, "World position (x, y, z) of the centre of voxel [0, 0, 0].")
      .def_property_readonly("source", [](const PythonVolume& v) { return fileNameOf(v.describe().source); }, "File and grid, for messages.");
}

void addRenderer(py::module_& module) {
  using namespace py::literals;
  py::class_<SceneRenderer>(module, "Renderer",
                             "Renders one volume many times. What frames have in common, the attenuation table above all, is\n"
                             "kept on the device, and is made again only for a frame whose options change it. Threads may share\n"
                             "a renderer; its frames are drawn one after another.")
      .def(py::init(&makeRenderer), "volume"_a, "Options given here hold for every frame.")
      .def("render", &render, py::kw_only(), "progress"_a = py::none(), "depth"_a = false,
           "Returns float32 (height, width, 4): linear red, green and blue, multiplied by alpha, and alpha; row 0 is the top.\n"
           "With depth=True returns (image, depth), the latter float32 (height, width): mean distance along the viewing axis\n"
           "of what is seen, infinite where there is nothing. progress(stage, fraction) is called about every 50 ms of work;\n"
           "an exception that it raises abandons the frame. It may draw with other renderers. Options given here hold for this frame.")
      .def_property_readonly("timings", &timingsOf, "List of (stage, milliseconds) of the last complete frame and of the data from which it was drawn.")
      .def_property_readonly("device", [](const SceneRenderer& r) { return r.context()->device->description().name; }, "Name of the Vulkan device.");
}

/// Whether a keyword of render() is of the volume, which is a file or an array, instead of the frame.
bool isOfVolume(std::string keyword, bool isFile) {
  constexpr std::array kOfArrays{"spacing", "origin", "transform", "no_data", "temperature"};
  if (!isFile) return std::ranges::find(kOfArrays, keyword) != kOfArrays.end();
  std::ranges::replace(keyword, '_', '-');
  return std::ranges::any_of(sceneFields(), [&](const SceneField& field) { return field.section == "input" && field.name == keyword; });
}

/// A file is read with all keywords, since the scene decides which of its grids are needed. Without a source it is the file of the scene.
py::object renderOnce(const py::object& source, const py::object& progress, bool depth, const py::kwargs& keywords) {
  const py::object type = py::type::of<PythonVolume>();
  py::object volume = source;
  py::kwargs ofFrame = keywords;
  if (!py::isinstance<PythonVolume>(source)) {
    const bool isFile = source.is_none() || py::isinstance<py::str>(source) || py::hasattr(source, "__fspath__");
    py::dict ofVolume;
    ofFrame = py::kwargs();
    for (const auto& [key, value] : keywords) {
      const bool ofVolumeAlone = isOfVolume(keywordText(key), isFile);
      if (isFile || ofVolumeAlone) ofVolume[key] = value;
      if (!ofVolumeAlone) ofFrame[key] = value;
    }
    volume = (isFile ? py::object(type.attr("open")) : type)(source, **ofVolume);
  }
  return render(*makeRenderer(volume.cast<PythonVolume>(), ofFrame), progress, depth, {});
}

}  // namespace

PYBIND11_MODULE(freevoxels, module) {
  using namespace py::literals;
  module.doc() = kModuleText;
  module.attr("__version__") = programVersion();
  logToPython();
  addExceptions(module);
  addVolume(module);
  addRenderer(module);
  module.def("render", &renderOnce, "volume"_a = py::none(), py::kw_only(), "progress"_a = py::none(), "depth"_a = false,
             "Renders an array, a file or a Volume once, as Renderer(...).render() does. Also takes the keywords of Volume for an\n"
             "array, and those of Volume.open for a file. Without a volume it is that of the scene: render(**load_scene('a.json')).");
  module.def("load_scene", &loadSceneFile, "file"_a,
             "Reads a scene file, which the command line, the viewer or save_scene wrote: a dictionary of sections, which are keywords\n"
             "of render, Volume.open, Renderer and save. File names become absolute.");
  module.def("save_scene", &saveSceneFile, "file"_a,
             "Writes options, sections or a whole scene as a scene file for the command line and the viewer.");
  module.def("save", &save, "file"_a, "image"_a, py::kw_only(), "depth"_a = py::none(),
             "Writes an image to a .png, 8-bit sRGB over a background, or to an .exr, linear, which may have depth. Options:\n"
             "background, exposure, tone_map, float.");
}

}  // namespace freevoxels
