#include "apps/python/python_tools.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/common/device_options.h"
#include "apps/common/scene_tools.h"
#include "apps/python/call_arguments.h"
#include "apps/python/python_values.h"
#include "apps/python/python_volume.h"
#include "engine/core/error.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

namespace py = pybind11;
using Json = nlohmann::json;

py::object devices() {
  Json found;
  {
    const py::gil_scoped_release withoutGil;
    found = toJson(findDevices());
  }
  return pythonOf(found);
}

py::object info(const py::object& volume, const py::args& more, const py::object& check, const py::kwargs& keywords) {
  refuseMore(more, "info()", "one volume");
  Json options = jsonOf(keywords);
  options["check"] = flagOf(check, "check");
  const std::string name = pathOf(volume).string();
  Json found;
  {
    const py::gil_scoped_release withoutGil;
    found = infoOf(name, options);
  }
  return pythonOf(found);
}

py::object presets() {
  return pythonOf(Json::parse(presetsJson()));
}

void bakeOpened(const PythonVolume& volume, const std::string& file, const Json& options, const Progress& report) {
  const py::gil_scoped_release withoutGil;
  bakeShared(*volume.volume, file, options, report);
}

void bake(const py::object& volume, const py::object& file, const py::args& more, const py::object& keepScalars, const py::object& compress,
          const py::object& progress, const py::kwargs& keywords) {
  refuseMore(more, "bake()", "a volume and a file");
  const std::string name = pathOf(file).string();
  const Progress callback = progressOf(progress);
  const Progress watch = watchSignals();
  const Progress report = progress.is_none() ? watch : callback;
  const auto optionsOf = [&](const py::kwargs& given) {
    Json options = jsonOf(given);
    options["keep-scalars"] = flagOf(keepScalars, "keep-scalars");
    options["compress"] = flagOf(compress, "compress");
    return options;
  };
  if (py::isinstance<PythonVolume>(volume)) {
    refusePlacement(keywords, "a volume");
    return bakeOpened(volume.cast<const PythonVolume&>(), name, optionsOf(keywords), report);
  }
  if (volume.is_none() || py::isinstance<py::str>(volume) || py::hasattr(volume, "__fspath__")) {
    refuseArrayOptions(keywords);
    const std::string source = volume.is_none() ? "" : pathOf(volume).string();
    const Json options = optionsOf(keywords);
    const py::gil_scoped_release withoutGil;
    return bakeFile(source, name, options, [](const Scene& scene) { warnInPython(*scene.volume); }, report);
  }
  py::kwargs ofVolume, others;
  for (const auto& [key, value] : keywords) (isOfArrays(keywordOf(keywordText(key))) ? ofVolume : others)[key] = value;
  bakeOpened(volumeFromArray(py::args(py::make_tuple(volume)), ofVolume), name, optionsOf(others), report);
}

void convert(const py::object& volume, const py::object& file, const py::args& more, const py::object& progress,
             const py::kwargs& keywords) {
  refuseMore(more, "convert()", "a volume and a file");
  const std::string source = pathOf(volume).string(), name = pathOf(file).string();
  const Json options = jsonOf(keywords);
  const Progress callback = progressOf(progress);
  const Progress report = progress.is_none() ? watchSignals() : callback;
  const py::gil_scoped_release withoutGil;
  convertFile(
      source, name, options, [](const Volume& read) { warnInPython(read); }, report);
}

void merge(const py::object& parts, const py::object& images, const py::args& more, const py::kwargs& keywords) {
  refuseMore(more, "merge()", "the parts and the images");
  const std::vector<std::string> files = namesOf(parts, "parts"), written = namesOf(images, "images");
  const Json options = jsonOf(keywords);
  const py::gil_scoped_release withoutGil;
  mergeFiles(files, written, options);
}

}  // namespace

void addTools(py::module_& module) {
  using namespace py::literals;
  module.def("devices", &devices,
             "devices()\n--\n\n"
             "The Vulkan devices of this machine, as 'freevoxels devices --json' lists them: dictionaries with index, name, type, uuid,\n"
             "driver, memory_bytes, usable and rejections, the reasons why one is not usable.");
  module.def("presets", &presets,
             "presets()\n--\n\n"
             "The transfer functions that transfer_function= takes by name, as 'freevoxels presets --json' prints them: a dictionary of\n"
             "functions by their names. presets()['ct-bone']['description'] says what one is for. Changed, it can be transfer_function=.");
  module.def(
      "info", &info, "volume"_a, "check"_a = false,
      "info(volume, *, check=False, **kwargs)\n--\n\n"
      "What a file or 'procedural:NAME' holds, as 'freevoxels info --json' says it: a dictionary of its grids, or of a baked volume.\n"
      "check=True reads all of a baked volume, and raises InputError where anything is damaged. Options: resolution,\n"
      "raw, series, time_step, spacing, pyramid_level.");
  module.def("bake", &bake, "volume"_a, "file"_a, "keep_scalars"_a = false, "compress"_a = false, "progress"_a = py::none(),
             "bake(volume, file, *, keep_scalars=False, compress=False, progress=None, **kwargs)\n--\n\n"
             "Classifies a volume once and writes a baked volume, whose name ends in .fvx: of a file, 'procedural:NAME', an array or a\n"
             "Volume, or None for that of a scene. Options are those of 'freevoxels bake', grid, resolution, classification and emission,\n"
             "and for an array those of Volume. Files too large for memory are read part by part. progress(stage, fraction) may abandon it.");
  module.def("convert", &convert, "volume"_a, "file"_a, "progress"_a = py::none(),
             "convert(volume, file, *, progress=None, **kwargs)\n--\n\n"
             "Writes the values of a file or 'procedural:NAME', before they are classified, to a file that ends in .vdb, .nrrd, .nii or\n"
             ".nii.gz, as 'freevoxels convert' does. Options: grid, resolution, raw, series, time_step, spacing, pyramid_level, no_data,\n"
             "clip_box, clip_plane. progress(stage, fraction) may abandon reading.");
  module.def("merge", &merge, "parts"_a, "images"_a,
             "merge(parts, images, **kwargs)\n--\n\n"
             "Adds up the files of sums that 'freevoxels render --share I/N --sums' wrote, and writes the image, as 'freevoxels merge'\n"
             "does. parts and images are names or lists of them. Options are those of save().");
}

}  // namespace freevoxels
