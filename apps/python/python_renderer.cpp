#include "apps/python/python_renderer.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/common/scene_renderer.h"
#include "apps/python/call_arguments.h"
#include "apps/python/python_values.h"
#include "apps/python/python_volume.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/description/scene_fields.h"

namespace freevoxels {

namespace {

namespace py = pybind11;
using Json = nlohmann::json;

std::unique_ptr<SceneRenderer> makeRenderer(const PythonVolume& volume, const py::kwargs& keywords) {
  refusePlacement(keywords, "a volume");
  Json options = jsonOf(keywords);
  std::unique_ptr<SceneRenderer> renderer;
  {
    const py::gil_scoped_release withoutGil;  // which another thread may need that opens the device
    renderer = std::make_unique<SceneRenderer>(volume.volume, std::move(options));
  }
  if (volume.isOfArray && !volume.describe().temperature && renderer->read(Json::object())->scene.emission.isAsked())
    fail(ErrorKind::Usage, "{} needs temperatures, which the array has not: give {}, an array of the same shape, with it",
         Parameter("emission"), Parameter("temperature"));
  return renderer;
}

std::unique_ptr<SceneRenderer> newRenderer(const py::args& arguments, const py::kwargs& named) {
  const auto [volume, keywords] = oneOf(arguments, named, "volume", "Renderer()");
  if (!py::isinstance<PythonVolume>(volume))
    fail(ErrorKind::Input, "a renderer takes a Volume, not {}: make one with Volume(array) or Volume.open(file)", typeName(volume));
  return makeRenderer(volume.cast<const PythonVolume&>(), keywords);
}

std::optional<double> budgetOf(const py::object& budget) {
  if (budget.is_none()) return std::nullopt;
  const Json number = jsonOf(budget, "budget");
  if (!number.is_number()) fail(ErrorKind::Usage, "{} takes a number of milliseconds, not {}", Parameter("budget"), typeName(budget));
  return number.get<double>();
}

py::object render(SceneRenderer& renderer, const py::args& more, const py::object& progress, const py::object& depth, const py::object& aov,
                  const py::object& budget, py::kwargs keywords) {
  refuseMore(more, "render()", "nothing");
  const Wanted wanted = wantedOf(depth, aov);
  const std::shared_ptr<const Holdout> holdout = takeHoldout(keywords);
  refusePlacement(keywords, "a volume");
  const Json options = jsonOf(keywords);
  const Progress report = progressOf(progress);
  const std::optional<double> milliseconds = budgetOf(budget);
  Image image;
  {
    const py::gil_scoped_release withoutGil;
    const std::unique_ptr<const KeywordOptions> frame = renderer.read(options, holdout, milliseconds);
    for (const std::string& warning : frame->warnings) tellPython(warning, true);
    image = renderer.render(*frame, wanted.channels, report);
  }
  return wanted.resultOf(image);
}

/// The frames of a turn, drawn one by one as they are asked for. Keeps its renderer.
struct Turntable {
  py::object renderer, progress;
  std::shared_ptr<const KeywordOptions> options;
  TurnViews turn;
  int next = 0;
  Wanted wanted;

  py::object draw() {
    if (next == turn.frames) throw py::stop_iteration();
    auto& drawn = renderer.cast<SceneRenderer&>();
    const Progress report = progressOf(progress);
    const std::shared_ptr<const KeywordOptions> ofTurn = options;
    const TurnStep step{next, turn};
    Image image;
    {
      const py::gil_scoped_release withoutGil;
      image = drawn.renderTurn(*ofTurn, step, wanted.channels, report);
    }
    ++next;
    return wanted.resultOf(image);
  }
};

Turntable turntableOf(const py::object& renderer, const py::object& count, const py::args& more, const py::object& progress,
                      const py::object& depth, const py::object& aov, const py::kwargs& keywords) {
  refuseMore(more, "turntable()", "the number of frames");
  if (count.is_none()) fail(ErrorKind::Usage, "{} is missing: give the number of images", Parameter("frames"));
  const Json number = jsonOf(count, "frames");
  if (!number.is_number_integer()) fail(ErrorKind::Usage, "{} takes a whole number, not {}", Parameter("frames"), typeName(count));
  const auto frames = number.get<std::int64_t>();
  if (frames < 1 || frames > kMaximumFrames)
    fail(ErrorKind::Usage, "{} of a turntable are 1 to {}, not {}", Parameter("frames"), kMaximumFrames, frames);
  refusePlacement(keywords, "a volume");
  progressOf(progress);
  return {.renderer = renderer,
          .progress = progress,
          .options = renderer.cast<SceneRenderer&>().read(jsonOf(keywords)),
          .turn = {.frames = int(frames)},
          .wanted = wantedOf(depth, aov)};
}

/// Whether a keyword of render() is of the file that is opened, instead of the frame.
bool isOfFiles(const std::string& keyword) {
  return std::ranges::any_of(sceneFields(),
                             [&](const SceneField& field) { return field.section == "input" && keywordOf(field.name) == keyword; });
}

bool isFileName(const py::object& value) {
  return py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__");
}

/// Whether a source is a list of volumes, and no list of numbers that is an array.
bool areVolumes(const py::object& source) {
  if (!py::isinstance<py::list>(source) && !py::isinstance<py::tuple>(source)) return false;
  const py::sequence several(source);
  return !several.empty() && (py::isinstance<PythonVolume>(several[0]) || isFileName(several[0]));
}

/// The keywords with the volumes behind the first one among `volumes`. Arrays become volumes, which are in `kept` as long as they are
/// drawn.
py::kwargs withVolumes(const py::sequence& several, const py::kwargs& keywords, py::list& kept) {
  py::list added;
  for (std::size_t i = 1; i < several.size(); ++i) {
    const py::object one = several[i];
    const bool isKnown = py::isinstance<PythonVolume>(one) || isFileName(one) || py::isinstance<py::dict>(one);
    added.append(isKnown ? one : py::cast(volumeFromArray(py::make_tuple(one), {})));
    kept.append(added[i - 1]);
  }
  if (keywords.contains("volumes"))
    for (const py::handle more : py::list(keywords["volumes"])) added.append(more);
  py::kwargs all;
  for (const auto& [key, value] : keywords) all[key] = value;
  all["volumes"] = added;
  return all;
}

/// A file is read with all keywords, since the scene decides which of its grids are needed. Without a source it is the file of the scene.
py::object renderOnce(const py::args& arguments, const py::object& progress, const py::object& depth, const py::object& aov,
                      const py::kwargs& named) {
  auto [source, keywords] = oneOf(arguments, named, "volume", "render()");
  wantedOf(depth, aov);
  progressOf(progress);  // fails before a volume is read for what cannot be called
  py::list kept;
  if (areVolumes(source)) {
    const py::sequence several(source);
    keywords = withVolumes(several, keywords, kept);
    source = several[0];
  }
  py::kwargs held;  // what may be an array is of the frame
  if (keywords.contains("holdout")) held["holdout"] = keywords.attr("pop")("holdout");
  if (py::isinstance<PythonVolume>(source))
    return render(*makeRenderer(source.cast<const PythonVolume&>(), keywords), {}, progress, depth, aov, py::none(), held);
  const bool isFile = source.is_none() || isFileName(source);
  py::kwargs ofVolume, ofFrame;
  for (const auto& [key, value] : keywords) {
    const std::string name = keywordOf(keywordText(key));
    const bool ofVolumeAlone = isFile ? isOfFiles(name) || isPlacement(name) : isOfArrays(name);
    if (isFile || ofVolumeAlone) ofVolume[key] = value;
    if (!ofVolumeAlone) ofFrame[key] = value;
  }
  const PythonVolume volume = isFile ? volumeFromFile(source, {}, ofVolume) : volumeFromArray(py::args(py::make_tuple(source)), ofVolume);
  return render(*makeRenderer(volume, ofFrame), {}, progress, depth, aov, py::none(), held);
}

}  // namespace

void addRenderer(py::module_& module) {
  using namespace py::literals;
  py::class_<Turntable>(module, "_Turntable", "The images of a full turn, in order. Each is drawn when it is asked for.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &Turntable::draw)
      .def("__len__", [](const Turntable& turntable) { return turntable.turn.frames - turntable.next; });
  py::class_<SceneRenderer>(module, "Renderer",
                            "Renderer(volume, **kwargs)\n--\n\n"
                            "Renders one volume many times. What frames have in common, the attenuation table above all, is\n"
                            "kept on the device, and is made again only for a frame whose options change it. Threads may share\n"
                            "a renderer; its frames are drawn one after another. Its own options give the view: the distance of the\n"
                            "eye, the point that it looks at, and the default lights. The orbit of a frame turns the eye around that\n"
                            "point.")
      .def(py::init(&newRenderer), "__init__(self, volume, **kwargs)\n--\n\nOptions given here hold for every frame.")
      .def("__repr__",
           [](const SceneRenderer& r) {
             return fmt::format("<freevoxels.Renderer on {}>", printable(r.context()->device->description().name));
           })
      .def("turntable", &turntableOf, "frames"_a = py::none(), "progress"_a = py::none(), "depth"_a = false, "aov"_a = py::none(),
           "turntable(self, frames, *, progress=None, depth=False, aov=None, **kwargs)\n--\n\n"
           "Yields the images of a full turn around the volume, as 'freevoxels turntable' draws them: the eye is as far away in all of\n"
           "them as the farthest needs, and the light does not move. Options hold for all frames; orbit is the place of the first.\n"
           "With flight, key frames of camera and lights, the frames are at equal steps of time from the first key to the last.\n"
           "The file of a flight may change as soon as the first image is drawn. progress, depth and aov are those of render().")
      .def("render", &render, "progress"_a = py::none(), "depth"_a = false, "aov"_a = py::none(), "budget"_a = py::none(),
           "render(self, *, progress=None, depth=False, aov=None, budget=None, **kwargs)\n--\n\n"
           "Returns float32 (height, width, 4): linear red, green and blue, multiplied by alpha, and alpha; row 0 is the top.\n"
           "With depth=True returns (image, depth), the latter float32 (height, width): mean distance along the viewing axis\n"
           "of what is seen, infinite where there is nothing. With aov='depth,position,normal,transmittance', or some of them, returns\n"
           "(image, dictionary of arrays), which save() writes. progress(stage, fraction) is called about every 50 ms of work,\n"
           "and at the end, with the fraction of the frame that is done, which never decreases and ends at 1;\n"
           "an exception that it raises abandons the frame. It may draw with other renderers. Options given here hold for this frame.\n"
           "holdout may also be an array (height, width) of depths, such as this function returns. With budget, in milliseconds, draws\n"
           "a draft that is to take no longer, for what moves: its quality follows from the times of the frames before.")
      .def_property_readonly(
          "timings", [](const SceneRenderer& r) { return timingsOf(r.timings()); },
          "List of (stage, milliseconds): the stages that the last complete frame ran.")
      .def_property_readonly(
          "camera", [](const SceneRenderer& r) { return cameraOf(r.camera()); },
          "The camera of the last complete frame as keywords of render(): camera_position, look_at and up in world\n"
          "units, fov in degrees or orthographic in world units, and size in pixels. None before the first frame.")
      .def_property_readonly(
          "device", [](const SceneRenderer& r) { return r.context()->device->description().name; }, "Name of the Vulkan device.");
  module.def("render", &renderOnce, "progress"_a = py::none(), "depth"_a = false, "aov"_a = py::none(),
             "render(volume=None, *, progress=None, depth=False, aov=None, **kwargs)\n--\n\n"
             "Renders an array, a file or a Volume once, as Renderer(...).render() does. Also takes the keywords of Volume for an\n"
             "array, and those of Volume.open for a file. Without a volume it is that of the scene: render(**load_scene('a.json')).");
}

}  // namespace freevoxels
