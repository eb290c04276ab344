#pragma once
// How frames are seen that give something else than the renderer or the film that they belong to.

#include <nlohmann/json.hpp>

#include "engine/description/scene_description.h"

namespace freevoxels {

/// The camera at another place around its look-at point, at the same distance. `orbit` is as CameraDescription has it.
Camera movedTo(glm::dvec2 orbit, glm::dvec3 up, Camera camera);

/// A film, resolved of `own`, with what a frame gives in its place: an orbit moves the eye about the film's look-at point, the size
/// changes nothing else, and scales that are not given stay. Fails with ErrorKind::Usage where the frame is to shine, and the film does not.
Scene filmWith(const Scene& film, const SceneDescription& own, const SceneDescription& given);

/// A camera and the size of its image as keywords that give them.
nlohmann::json keywordsOf(const Camera& camera, glm::ivec2 size);

}  // namespace freevoxels
