// The compiled part of the Python package `freevoxels`: arrays and files in, images as arrays out.

#include <pybind11/pybind11.h>

#include <filesystem>
#include <optional>
#include <nlohmann/json.hpp>

#include "apps/common/program.h"
#include "apps/common/scene_renderer.h"
#include "apps/python/call_arguments.h"
#include "apps/python/numpy_array.h"
#include "apps/python/python_renderer.h"
#include "apps/python/python_sequence.h"
#include "apps/python/python_tools.h"
#include "apps/python/python_values.h"
#include "apps/python/python_volume.h"

namespace freevoxels {

namespace {

namespace py = pybind11;

void save(const py::object& name, const py::object& image, const py::object& depth, const py::kwargs& keywords) {
  const std::filesystem::path file = pathOf(name);
  py::kwargs others;
  std::optional<py::dict> channels;  // arrays, in place of the names of what can be made of the image
  for (const auto& [key, value] : keywords)
    if (keywordText(key) == "aov" && py::isinstance<py::dict>(value))
      channels = py::reinterpret_borrow<py::dict>(value);
    else
      others[key] = value;
  const nlohmann::json options = jsonOf(others);
  Image pixels = imageOf(image, depth);
  if (channels) addChannels(pixels, *channels);
  const py::gil_scoped_release withoutGil;
  saveImage(file.string(), pixels, options);
}

py::object loadSceneFile(const py::object& file) {
  const std::filesystem::path path = pathOf(file);
  for (const std::string& warning : sceneWarnings(path)) tellPython(warning, true);
  return pythonOf(loadScene(path));
}

void saveSceneFile(const py::object& file, const py::kwargs& keywords) {
  saveScene(pathOf(file), jsonOf(keywords));
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

}  // namespace

PYBIND11_MODULE(_core, module) {
  using namespace py::literals;
  py::options options;
  options.disable_function_signatures();  // the texts begin with those that inspect.signature() understands
  const py::object ownName = module.attr("__name__");
  module.attr("__name__") = "freevoxels";  // where users find the classes and functions, which take it as their module
  module.doc() = kModuleText;
  addArrayMemory(module);
  module.attr("__version__") = programVersion();
  logToPython();
  addExceptions(module);
  addVolume(module);
  addRenderer(module);
  addSequence(module);
  addTools(module);
  module.def("load_scene", &loadSceneFile, "file"_a,
             "load_scene(file)\n--\n\n"
             "Reads a scene file, which the command line, the viewer or save_scene wrote: a dictionary of sections, which are keywords\n"
             "of render, Volume.open, Renderer and save. File names become absolute.");
  module.def("save_scene", &saveSceneFile, "file"_a,
             "save_scene(file, **kwargs)\n--\n\n"
             "Writes options, sections or a whole scene as a scene file for the command line and the viewer.");
  module.def("save", &save, "file"_a, "image"_a, py::kw_only(), "depth"_a = py::none(),
             "save(file, image, *, depth=None, **kwargs)\n--\n\n"
             "Writes an image to a .png or .jpg, sRGB over a background, or to an .exr, linear, which may have depth. Options:\n"
             "background, exposure, tone_map, png_bits, crop, float, and aov: the dictionary of channels that render() returned.");
  module.attr("__name__") = ownName;
}

}  // namespace freevoxels
