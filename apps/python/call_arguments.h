#pragma once
// The arguments of the module's functions, some of which may be given without a name, and what they return. All functions must be called with the GIL held.

#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/stages.h"
#include "engine/description/aov.h"
#include "engine/image/image.h"
#include "engine/scene/holdout.h"

namespace freevoxels {

/// Fails with ErrorKind::Usage for arguments without a name, of which there are none beyond the first.
void refuseMore(const pybind11::args& more, const char* function, const char* first);

/// The one argument that may be given without its name, None if it is not given, and the keywords without it. Fails with
/// ErrorKind::Usage for more.
std::pair<pybind11::object, pybind11::kwargs> oneOf(const pybind11::args& arguments, const pybind11::kwargs& named, const char* name,
                                                    const char* function);

/// True or False. Fails with ErrorKind::Usage for others.
bool flagOf(const pybind11::object& value, const char* name);

/// The name of a file: text, bytes or a path. Fails with ErrorKind::Usage for others.
std::filesystem::path pathOf(const pybind11::object& file);

/// The name of a file or pattern, or those of a list; none of None. Fails with ErrorKind::Usage for others.
std::vector<std::string> namesOf(const pybind11::object& names, const char* keyword);

/// Takes the depths of `holdout` out of the keywords, where that is an array; null where it is the name of a file, or missing. Fails with
/// ErrorKind::Input for arrays of other than two dimensions, and for values that are no depths.
std::shared_ptr<const Holdout> takeHoldout(pybind11::kwargs& keywords);

/// What a drawing function returns beside the colours.
struct Wanted {
  Aovs channels;
  bool byName = false;  ///< whether channels are returned in a dictionary

  /// Takes over the image's memory.
  pybind11::object resultOf(Image& image) const;
};

/// Reads the arguments `depth` and `aov`. Fails with ErrorKind::Usage where both are given.
Wanted wantedOf(const pybind11::object& depth, const pybind11::object& aov);

/// The keywords that SceneRenderer::camera() has, None where there are none.
pybind11::object cameraOf(const nlohmann::json& camera);

/// Pairs of names and milliseconds.
std::vector<std::pair<std::string, double>> timingsOf(const std::vector<StageTime>& times);

}  // namespace freevoxels
