#include "apps/python/python_sequence.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/common/scene_sequence.h"
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

/// The frames that a range has, as the option --frames has them; other values as they are.
py::object framesOf(const py::object& frames) {
  const py::object rangeType = py::module_::import("builtins").attr("range");
  if (!py::isinstance(frames, rangeType)) return frames;
  if (py::len(frames) == 0 || frames.attr("step").cast<std::int64_t>() < 0)
    fail(ErrorKind::Usage, "{} takes a range of numbers that increase, and {} has none", Parameter("frames"), py::repr(frames).cast<std::string>());
  return py::str("{}-{}:{}").attr("format")(frames[py::int_(0)], frames[py::int_(-1)], frames.attr("step"));
}

/// The keywords of a sequence as it takes them.
Json optionsOf(const py::object& frames, const py::object& fixedView, const py::kwargs& keywords) {
  refuseArrayOptions(keywords);
  Json options = jsonOf(keywords);
  if (!frames.is_none()) options["frames"] = jsonOf(framesOf(frames), "frames");
  if (!fixedView.is_none()) options["fixed-view"] = flagOf(fixedView, "fixed-view");
  return options;
}

std::unique_ptr<SceneSequence> makeSequence(std::vector<std::string> names, Json options) {
  const py::gil_scoped_release withoutGil;
  return std::make_unique<SceneSequence>(std::move(names), std::move(options), &tellPython);
}

std::unique_ptr<SceneSequence> newSequence(const py::object& volume, const py::args& more, const py::object& frames,
                                           const py::object& fixedView, const py::kwargs& keywords) {
  refuseMore(more, "Sequence()", "one pattern, or a list");
  return makeSequence(namesOf(volume, "volume"), optionsOf(frames, fixedView, keywords));
}

py::object drawFrame(SceneSequence& sequence, std::size_t frame, const py::object& progress, const Wanted& wanted, const Json& options,
                     const std::shared_ptr<const Holdout>& holdout = nullptr) {
  const Progress report = progressOf(progress);
  Image image;
  {
    const py::gil_scoped_release withoutGil;
    image = sequence.render(frame, *sequence.read(options, holdout), wanted.channels, report);
  }
  return wanted.resultOf(image);
}

py::object renderFrame(SceneSequence& sequence, const py::object& frame, const py::args& more, const py::object& progress,
                       const py::object& depth, const py::object& aov, py::kwargs keywords) {
  refuseMore(more, "render()", "the frame");
  const std::shared_ptr<const Holdout> holdout = takeHoldout(keywords);
  const std::size_t count = sequence.volumes().size();
  const Json number = jsonOf(frame, "frame");
  if (!number.is_number_integer() || number.get<std::int64_t>() < 0 || number.get<std::size_t>() >= count)
    fail(ErrorKind::Usage, "{} is the place of a frame in the sequence, from 0 to {}, not {}", Parameter("frame"), count - 1,
         py::repr(frame).cast<std::string>());
  const Wanted wanted = wantedOf(depth, aov);
  refusePlacement(keywords, "a file");
  return drawFrame(sequence, number.get<std::size_t>(), progress, wanted, jsonOf(keywords), holdout);
}

/// The images of a sequence, drawn one by one as they are asked for. Keeps the sequence.
struct SequenceImages {
  py::object sequence;
  std::size_t next = 0;

  py::object draw() {
    auto& drawn = sequence.cast<SceneSequence&>();
    if (next == drawn.volumes().size()) throw py::stop_iteration();
    return drawFrame(drawn, next++, py::none(), {}, Json::object());
  }
};

py::list numbersOf(const SceneSequence& sequence) {
  py::list numbers;
  for (const NumberedVolume& volume : sequence.volumes()) {
    const double value = volume.number.value;
    numbers.append(value == std::floor(value) ? py::object(py::int_(std::int64_t(value))) : py::object(py::float_(value)));
  }
  return numbers;
}

py::list pythonNames(const std::vector<std::string>& names) {
  py::list list;
  for (const std::string& name : names) list.append(fileNameOf(name));
  return list;
}

py::list filesOf(const SceneSequence& sequence) {
  std::vector<std::string> files;
  for (const NumberedVolume& volume : sequence.volumes()) files.push_back(volume.file);
  return pythonNames(files);
}

/// Whether a keyword is of the images that are written.
bool isOfOutput(const std::string& keyword) {
  return keyword == "output" || std::ranges::any_of(sceneFields(), [&](const SceneField& field) {
           return field.section == "output" && keywordOf(field.name) == keyword;
         });
}

py::list renderSequence(const py::object& volume, const py::object& images, const py::args& more, const py::object& frames,
                        const py::object& fixedView, const py::object& skipExisting, const py::object& progress,
                        const py::kwargs& keywords) {
  refuseMore(more, "render_sequence()", "the volumes and the images");
  const std::vector<std::string> files = namesOf(images, "images");
  if (files.empty()) fail(ErrorKind::Usage, "{} is missing: name the files to write, as in 'smoke_####.png'", Parameter("images"));
  const bool skips = flagOf(skipExisting, "skip_existing");
  const Progress report = progressOf(progress);
  py::kwargs ofFrames, ofOutput;
  for (const auto& [key, value] : keywords) {
    const std::string name = keywordOf(keywordText(key));
    if (isOfOutput(name) || name == "scene") ofOutput[key] = value;
    if (!isOfOutput(name)) ofFrames[key] = value;
  }
  const Json output = jsonOf(ofOutput);
  const std::unique_ptr<SceneSequence> sequence = makeSequence(namesOf(volume, "volume"), optionsOf(frames, fixedView, ofFrames));
  std::vector<std::string> written;
  {
    const py::gil_scoped_release withoutGil;
    written = sequence->save(files, output, skips, report);
  }
  return pythonNames(written);
}

}  // namespace

void addSequence(py::module_& module) {
  using namespace py::literals;
  py::class_<SequenceImages>(module, "_SequenceImages", "The images of a sequence, in order. Each is drawn when it is asked for.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &SequenceImages::draw)
      .def("__length_hint__", [](const SequenceImages& images) {
        return images.sequence.cast<SceneSequence&>().volumes().size() - images.next;
      });
  py::class_<SceneSequence>(module, "Sequence",
                            "Sequence(volume=None, *, frames=None, fixed_view=None, **kwargs)\n--\n\n"
                            "The frames of a film: files whose names differ in a number, as 'smoke_####.vdb' names them, or a list of files.\n"
                            "They are seen as the command line shows them: what options leave open of camera, lights and scales is chosen for\n"
                            "the film as a whole, for which the first image reads up to 12 frames. len() is the number of frames, and\n"
                            "iterating draws their images one by one. Threads may share a sequence.")
      .def(py::init(&newSequence), "volume"_a = py::none(), "frames"_a = py::none(), "fixed_view"_a = py::none(),
           "__init__(self, volume=None, *, frames=None, fixed_view=None, **kwargs)\n--\n\n"
           "volume: a pattern, in which a run of # or %04d stands for a frame's number, or a list of patterns and files; without it that\n"
           "of the scene. frames: a range, or text as of the option --frames: '1-240:2'. fixed_view: True takes view and scales of the first\n"
           "frame that holds anything, False those of each frame by itself. Options are those of Volume.open() and of Renderer.")
      .def("__len__", [](const SceneSequence& s) { return s.volumes().size(); })
      .def("__iter__", [](const py::object& self) { return SequenceImages{.sequence = self}; })
      .def("__repr__", [](const SceneSequence& s) {
        return fmt::format("<freevoxels.Sequence of {} frames from {}>", s.volumes().size(), printable(s.volumes().front().file));
      })
      .def("render", &renderFrame, "frame"_a, "progress"_a = py::none(), "depth"_a = false, "aov"_a = py::none(),
           "render(self, frame, *, progress=None, depth=False, aov=None, **kwargs)\n--\n\n"
           "Draws the frame at a place, from 0 to len() - 1, and returns what Renderer.render() does. The orbit of a frame turns the eye\n"
           "around the film's look-at point. The frame drawn last stays in memory, and is not read again. A frame that holds nothing is\n"
           "transparent; a file that cannot be read raises InputError, after which others can be drawn.")
      .def_property_readonly("files", &filesOf, "The file of each frame, in the order of their numbers.")
      .def_property_readonly("numbers", &numbersOf, "The number in the name of each file, or its place in the list of files.")
      .def_property_readonly("timings", [](const SceneSequence& s) { return timingsOf(s.timings()); },
                             "List of (stage, milliseconds): the stages that the last complete frame ran.")
      .def_property_readonly("camera", [](const SceneSequence& s) { return cameraOf(s.camera()); },
                             "The camera of the last complete frame, as Renderer.camera. None before the first frame.")
      .def_property_readonly("device", [](const SceneSequence& s) { return s.context()->device->description().name; },
                             "Name of the Vulkan device.");
  module.def("render_sequence", &renderSequence, "volume"_a, "images"_a, "frames"_a = py::none(), "fixed_view"_a = py::none(),
             "skip_existing"_a = false, "progress"_a = py::none(),
             "render_sequence(volume, images, *, frames=None, fixed_view=None, skip_existing=False, progress=None, **kwargs)\n--\n\n"
             "Draws the frames of a Sequence and writes each when it is complete, as 'freevoxels render' does: images is a name such as\n"
             "'smoke_####.png', or a list of them. skip_existing leaves out frames whose images exist. Also takes the options of save().\n"
             "progress(stage, fraction) gets the fraction of all frames that is done. A file that cannot be read is left out, and InputError\n"
             "raised at the end. Returns the names of the images.");
}

}  // namespace freevoxels
