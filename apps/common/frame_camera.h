#pragma once
// The cameras of frames that give another place than the renderer or the film that they belong to.

#include <nlohmann/json.hpp>

#include "engine/description/scene_description.h"

namespace freevoxels {

/// The camera at another place around its look-at point, at the same distance. `orbit` is as CameraDescription has it.
Camera movedTo(glm::dvec2 orbit, glm::dvec3 up, Camera camera);

/// The camera of a film, resolved of `own`, with what a frame gives in its place: an orbit moves the eye about the film's look-at point, and
/// the size changes nothing else.
Camera cameraInFilm(const Scene& film, const CameraDescription& own, const CameraDescription& given);

/// A camera and the size of its image as keywords that give them.
nlohmann::json keywordsOf(const Camera& camera, glm::ivec2 size);

}  // namespace freevoxels
