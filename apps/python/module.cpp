// The Python module `freevoxels`: arrays and files in, images as arrays out.

#include <fmt/ranges.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <glm/gtc/matrix_access.hpp>
#include <memory>
#include <optional>

#include "apps/freevoxels/program.h"
#include "apps/library/scene_renderer.h"
#include "apps/python/array_volume.h"
#include "apps/python/numpy_array.h"
#include "apps/python/python_values.h"
#include "engine/core/error.h"
#include "engine/core/nearest_name.h"
#include "engine/core/printable.h"
#include "engine/description/scene_fields.h"
#include "engine/volume/volume_of_scalars.h"

namespace freevoxels {

namespace {

namespace py = pybind11;
using Json = nlohmann::json;

struct PythonVolume {
  std::shared_ptr<const SharedVolume> volume;
  bool isOfArray = false;

  const Volume& describe() const { return volume->describe(); }
};

/// Fails for arguments without a name, of which there are none beyond the first.
void refuseMore(const py::args& more, const char* function, const char* first) {
  if (!more.empty()) fail(ErrorKind::Usage, "{} takes {} without a name, and options by name only: density_scale=40", function, first);
}

/// The one argument that may be given without its name, None if it is not given, and the keywords without it.
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

constexpr std::array kArrayKeywords{"spacing", "origin", "transform", "no_data", "temperature"};
/// What arrays have in common with files: their part that is drawn, also in the section "input".
constexpr std::array kClipKeywords{"clip_box", "clip_plane"};

bool isOfArrays(const std::string& keyword) {
  return std::ranges::find(kArrayKeywords, keyword) != kArrayKeywords.end();
}

/// Fails for keywords that say where an array is, which files and volumes know themselves.
void refuseArrayKeywords(const py::kwargs& keywords, const char* what) {
  for (const auto& [key, value] : keywords)
    if (const std::string name = keywordText(key); isOfArrays(name) && !value.is_none())
      fail(ErrorKind::Usage, "{} is an option of arrays, and {} has its own: leave it out", Parameter(name), what);
}

/// The numbers of a keyword; several unless `count` is 1. Nothing if it is not given.
std::optional<std::vector<double>> numbersOf(const py::kwargs& keywords, const char* name, std::size_t count, const char* form) {
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
  if (numbers.size() != count && !(count == 3 && value.is_number() && std::string_view(name) == "spacing"))
    fail(ErrorKind::Input, "{} takes {}, not {} number{}", Parameter(name), form, numbers.size(), numbers.size() == 1 ? "" : "s");
  return numbers;
}

glm::dmat4 placementOf(const py::kwargs& keywords) {
  const auto spacing = numbersOf(keywords, "spacing", 3, "one number, or three along (x, y, z)");
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

/// The clip box and plane among keywords, and in a section "input" of them, whose file an array replaces.
InputDescription clipOf(const py::kwargs& keywords) {
  Json clip = Json::object();
  const Json given = jsonOf(keywords);
  for (const auto& [key, value] : given.items()) {
    const auto keep = [&](Json& kept, std::string name, const Json& one) {
      std::ranges::replace(name, '-', '_');
      if (std::ranges::find(kClipKeywords, name) != kClipKeywords.end()) kept[name] = one;
    };
    keep(clip, key, value);
    if (key == "input" && value.is_object())
      for (const auto& [name, one] : value.items()) keep(clip["input"], name, one);
  }
  return KeywordOptions({clip}, {"input"}).scene.input;
}

PythonVolume volumeFromArray(const py::args& arguments, const py::kwargs& named) {
  const auto [array, keywords] = oneOf(arguments, named, "array", "Volume()");
  std::vector<std::string> known(kArrayKeywords.begin(), kArrayKeywords.end());
  known.insert(known.end(), kClipKeywords.begin(), kClipKeywords.end());
  py::kwargs ofClip;
  for (const auto& [key, value] : keywords)
    if (const std::string name = keywordText(key); name == "input" || std::ranges::find(kClipKeywords, name) != kClipKeywords.end())
      ofClip[key] = value;
    else if (!isOfArrays(name))
      fail(ErrorKind::Usage, "a volume of an array has no option {}{}", Parameter(name),
           suggestion(name, known).empty() ? fmt::format(": it has {}", fmt::join(known, ", ")) : suggestion(name, known));
  const auto of = [&](const char* name) { return keywords.contains(name) ? py::object(keywords[name]) : py::object(py::none()); };
  Volume volume = clipOf(ofClip).clip(volumeOfArray(array, of("temperature"), {placementOf(keywords), of("no_data")}));
  warnInPython(volume);
  return {std::make_shared<const SharedVolume>(std::move(volume)), true};
}

PythonVolume volumeFromFile(const py::object& file, const py::args& more, const py::kwargs& keywords) {
  refuseMore(more, "Volume.open()", "one file");
  refuseArrayKeywords(keywords, "a file");
  const Json options = jsonOf(keywords);
  const std::string name = file.is_none() ? "" : pathOf(file).string();
  PythonVolume opened;
  {
    const py::gil_scoped_release withoutGil;
    opened.volume = openVolume(name, options);
  }
  warnInPython(opened.describe());
  return opened;
}

/// The volume of a renderer. Fails for other objects.
const PythonVolume& volumeOf(const py::object& object) {
  if (!py::isinstance<PythonVolume>(object))
    fail(ErrorKind::Input, "a renderer takes a Volume, not {}: make one with Volume(array) or Volume.open(file)", typeName(object));
  return object.cast<const PythonVolume&>();
}

std::unique_ptr<SceneRenderer> makeRenderer(const py::object& object, const py::kwargs& keywords) {
  const PythonVolume& volume = volumeOf(object);
  refuseArrayKeywords(keywords, "a volume");
  Json options = jsonOf(keywords);
  std::unique_ptr<SceneRenderer> renderer;
  {
    const py::gil_scoped_release withoutGil;  // which another thread may need that opens the device
    renderer = std::make_unique<SceneRenderer>(volume.volume, std::move(options));
  }
  if (volume.isOfArray && !volume.describe().temperature && renderer->read(Json::object())->scene.emission.grid())
    fail(ErrorKind::Usage, "{} needs temperatures, which the array has not: give {}, an array of the same shape, with it", Parameter("emission"),
         Parameter("temperature"));
  return renderer;
}

std::unique_ptr<SceneRenderer> newRenderer(const py::args& arguments, const py::kwargs& named) {
  const auto [volume, keywords] = oneOf(arguments, named, "volume", "Renderer()");
  return makeRenderer(volume, keywords);
}

py::object resultOf(Image& image, bool depth) {
  if (!depth) return pixelsOf(image);
  return py::make_tuple(pixelsOf(image), depthOf(image));
}

py::object render(SceneRenderer& renderer, const py::args& more, const py::object& progress, const py::object& withDepth,
                  const py::kwargs& keywords) {
  refuseMore(more, "render()", "nothing");
  const bool depth = flagOf(withDepth, "depth");
  refuseArrayKeywords(keywords, "a volume");
  const Json options = jsonOf(keywords);
  const Progress report = progressOf(progress);
  Image image;
  {
    const py::gil_scoped_release withoutGil;
    image = renderer.render(*renderer.read(options), depth, report);
  }
  return resultOf(image, depth);
}

/// The frames of a turn, drawn one by one as they are asked for. Keeps its renderer.
struct Turntable {
  py::object renderer, progress;
  std::shared_ptr<const KeywordOptions> options;
  int frames = 0, next = 0;
  bool depth = false;

  py::object draw() {
    if (next == frames) throw py::stop_iteration();
    auto& drawn = renderer.cast<SceneRenderer&>();
    const Progress report = progressOf(progress);
    const std::shared_ptr<const KeywordOptions> ofTurn = options;
    const TurnStep step{next, frames};
    Image image;
    {
      const py::gil_scoped_release withoutGil;
      image = drawn.renderTurn(*ofTurn, step, depth, report);
    }
    ++next;
    return resultOf(image, depth);
  }
};

Turntable turntableOf(const py::object& renderer, const py::object& count, const py::args& more, const py::object& progress,
                      const py::object& depth, const py::kwargs& keywords) {
  refuseMore(more, "turntable()", "the number of frames");
  if (count.is_none()) fail(ErrorKind::Usage, "{} is missing: give the number of images", Parameter("frames"));
  const Json number = jsonOf(count, "frames");
  if (!number.is_number_integer()) fail(ErrorKind::Usage, "{} takes a whole number, not {}", Parameter("frames"), typeName(count));
  const auto frames = number.get<std::int64_t>();
  if (frames < 1 || frames > kMaximumFrames)
    fail(ErrorKind::Usage, "{} of a turntable are 1 to {}, not {}", Parameter("frames"), kMaximumFrames, frames);
  refuseArrayKeywords(keywords, "a volume");
  progressOf(progress);
  return {.renderer = renderer,
          .progress = progress,
          .options = renderer.cast<SceneRenderer&>().read(jsonOf(keywords)),
          .frames = int(frames),
          .depth = flagOf(depth, "depth")};
}

/// Options that give the camera of the last frame.
py::object cameraOf(const SceneRenderer& renderer) {
  const std::optional<CameraDescription> camera = renderer.camera();
  if (!camera) return py::none();
  const auto triple = [](const glm::dvec3& v) { return py::make_tuple(v.x, v.y, v.z); };
  py::dict fields;
  fields["camera_position"] = triple(*camera->position);
  fields["look_at"] = triple(*camera->lookAt);
  fields["up"] = triple(*camera->up);
  if (camera->orthographicHeight) fields["orthographic"] = *camera->orthographicHeight;
  if (camera->verticalFov) fields["fov"] = *camera->verticalFov;
  fields["size"] = py::make_tuple(camera->size.x, camera->size.y);
  return fields;
}

std::vector<std::pair<std::string, double>> timingsOf(const SceneRenderer& renderer) {
  std::vector<std::pair<std::string, double>> pairs;
  const py::gil_scoped_release withoutGil;
  for (const StageTime& time : renderer.timings()) pairs.emplace_back(time.name, time.milliseconds);
  return pairs;
}

void save(const py::object& name, const py::object& image, const py::object& depth, const py::kwargs& keywords) {
  const std::filesystem::path file = pathOf(name);
  const Json options = jsonOf(keywords);
  const Image pixels = imageOf(image, depth);
  const py::gil_scoped_release withoutGil;
  saveImage(file.string(), pixels, options);
}

py::object loadSceneFile(const py::object& file) {
  return pythonOf(loadScene(pathOf(file)));
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

void addVolume(py::module_& module) {
  using namespace py::literals;
  py::class_<PythonVolume>(module, "Volume",
                           "Volume(array, *, spacing=1.0, origin=(0.0, 0.0, 0.0), transform=None, no_data=None, temperature=None, clip_box=None, clip_plane=None, input=None)\n--\n\n"
                           "A volume in memory, which renderers can share.")
      .def(py::init(&volumeFromArray),
           "__init__(self, array, *, spacing=1.0, origin=(0.0, 0.0, 0.0), transform=None, no_data=None, temperature=None, clip_box=None, clip_plane=None, input=None)\n--\n\n"
           "Copies an array of real numbers with axes (z, y, x). spacing: world units between voxels, one number or along\n"
           "(x, y, z). origin: where the centre of voxel [0, 0, 0] is. transform: instead of both, a 4x4 affine matrix from\n"
           "(x, y, z, 1) in voxels to the world. NaN, and values equal to no_data in the array's own type, hold no data.\n"
           "temperature: an array of the same shape, for emission. clip_box, clip_plane: the part that is drawn, as for files, alone or\n"
           "in the section input of a scene, whose file the array replaces.")
      .def_static("open", &volumeFromFile, "file"_a = py::none(),
                  "open(file=None, **kwargs)\n--\n\n"
                  "Reads an OpenVDB file, or makes 'procedural:NAME'; without a file the volume of a scene. Options: grid, resolution, and those of a frame, of which\n"
                  "emission=True, temperature_grid and albedo_grid add grids to read. Of a baked volume (.fvx) a level of detail is read\n"
                  "when a frame needs it.")
      .def("__repr__", [](const PythonVolume& v) {
        const glm::ivec3 size = v.describe().dimensions;
        return fmt::format("<freevoxels.Volume of {}: {} x {} x {} voxels along z, y, x>", printable(v.describe().source), size.z, size.y, size.x);
      })
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
  py::class_<Turntable>(module, "_Turntable", "The images of a full turn, in order. Each is drawn when it is asked for.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &Turntable::draw)
      .def("__len__", [](const Turntable& turn) { return turn.frames - turn.next; });
  py::class_<SceneRenderer>(module, "Renderer",
                             "Renderer(volume, **kwargs)\n--\n\n"
                             "Renders one volume many times. What frames have in common, the attenuation table above all, is\n"
                             "kept on the device, and is made again only for a frame whose options change it. Threads may share\n"
                             "a renderer; its frames are drawn one after another. Its own options give the view: the distance of the eye, the point\n"
                             "that it looks at, and the default lights. The orbit of a frame turns the eye around that point.")
      .def(py::init(&newRenderer), "__init__(self, volume, **kwargs)\n--\n\nOptions given here hold for every frame.")
      .def("__repr__", [](const SceneRenderer& r) {
        return fmt::format("<freevoxels.Renderer on {}>", printable(r.context()->device->description().name));
      })
      .def("turntable", &turntableOf, "frames"_a = py::none(), "progress"_a = py::none(), "depth"_a = false,
           "turntable(self, frames, *, progress=None, depth=False, **kwargs)\n--\n\n"
           "Yields the images of a full turn around the volume, as 'freevoxels turntable' draws them: the eye is as far away in all of\n"
           "them as the farthest needs, and the light does not move. Options hold for all frames; orbit is the place of the first.\n"
           "progress and depth are those of render().")
      .def("render", &render, "progress"_a = py::none(), "depth"_a = false,
           "render(self, *, progress=None, depth=False, **kwargs)\n--\n\n"
           "Returns float32 (height, width, 4): linear red, green and blue, multiplied by alpha, and alpha; row 0 is the top.\n"
           "With depth=True returns (image, depth), the latter float32 (height, width): mean distance along the viewing axis\n"
           "of what is seen, infinite where there is nothing. progress(stage, fraction) is called about every 50 ms of work,\n"
           "and at the end, with the fraction of the frame that is done, which never decreases and ends at 1;\n"
           "an exception that it raises abandons the frame. It may draw with other renderers. Options given here hold for this frame.")
      .def_property_readonly("timings", &timingsOf, "List of (stage, milliseconds): the stages that the last complete frame ran.")
      .def_property_readonly("camera", &cameraOf,
                             "The camera of the last complete frame as keywords of render(): camera_position, look_at and up in world units,\n"
                             "fov in degrees or orthographic in world units, and size in pixels. None before the first frame.")
      .def_property_readonly("device", [](const SceneRenderer& r) { return r.context()->device->description().name; }, "Name of the Vulkan device.");
}

/// Whether a keyword of render() is of the array alone, instead of the frame.
bool isOfArrayAlone(std::string keyword) {
  std::ranges::replace(keyword, '-', '_');
  return keyword == "input" || isOfArrays(keyword) || std::ranges::find(kClipKeywords, keyword) != kClipKeywords.end();
}

/// Whether a keyword of render() is of the file that is opened, instead of the frame.
bool isOfFiles(std::string keyword) {
  std::ranges::replace(keyword, '_', '-');
  return std::ranges::any_of(sceneFields(), [&](const SceneField& field) { return field.section == "input" && field.name == keyword; });
}

/// A file is read with all keywords, since the scene decides which of its grids are needed. Without a source it is the file of the scene.
py::object renderOnce(const py::args& arguments, const py::object& progress, const py::object& depth, const py::kwargs& named) {
  const auto [source, keywords] = oneOf(arguments, named, "volume", "render()");
  flagOf(depth, "depth");
  progressOf(progress);  // fails before a volume is read for what cannot be called
  const py::object type = py::type::of<PythonVolume>();
  if (py::isinstance<PythonVolume>(source)) return render(*makeRenderer(source, keywords), {}, progress, depth, {});
  const bool isFile = source.is_none() || py::isinstance<py::str>(source) || py::hasattr(source, "__fspath__");
  py::dict ofVolume, ofFrame;
  for (const auto& [key, value] : keywords) {
    const std::string name = keywordText(key);
    const bool ofVolumeAlone = isFile ? isOfFiles(name) || isOfArrays(name) : isOfArrayAlone(name);
    if (isFile || ofVolumeAlone) ofVolume[key] = value;
    if (!ofVolumeAlone) ofFrame[key] = value;
  }
  const py::object volume = (isFile ? py::object(type.attr("open")) : type)(source, **ofVolume);
  return render(*makeRenderer(volume, py::kwargs(ofFrame)), {}, progress, depth, {});
}

}  // namespace

PYBIND11_MODULE(freevoxels, module) {
  using namespace py::literals;
  py::options options;
  options.disable_function_signatures();  // the texts begin with those that inspect.signature() understands
  module.doc() = kModuleText;
  addArrayMemory(module);
  module.attr("__version__") = programVersion();
  logToPython();
  addExceptions(module);
  addVolume(module);
  addRenderer(module);
  module.def("render", &renderOnce, "progress"_a = py::none(), "depth"_a = false,
             "render(volume=None, *, progress=None, depth=False, **kwargs)\n--\n\n"
             "Renders an array, a file or a Volume once, as Renderer(...).render() does. Also takes the keywords of Volume for an\n"
             "array, and those of Volume.open for a file. Without a volume it is that of the scene: render(**load_scene('a.json')).");
  module.def("load_scene", &loadSceneFile, "file"_a,
             "load_scene(file)\n--\n\n"
             "Reads a scene file, which the command line, the viewer or save_scene wrote: a dictionary of sections, which are keywords\n"
             "of render, Volume.open, Renderer and save. File names become absolute.");
  module.def("save_scene", &saveSceneFile, "file"_a,
             "save_scene(file, **kwargs)\n--\n\n"
             "Writes options, sections or a whole scene as a scene file for the command line and the viewer.");
  module.def("save", &save, "file"_a, "image"_a, py::kw_only(), "depth"_a = py::none(),
             "save(file, image, *, depth=None, **kwargs)\n--\n\n"
             "Writes an image to a .png, 8-bit sRGB over a background, or to an .exr, linear, which may have depth. Options:\n"
             "background, exposure, tone_map, float.");
}

}  // namespace freevoxels
