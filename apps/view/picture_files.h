#pragma once
// What is taken away of a picture: the files and command lines of `freevoxels render` and `turntable`.

#include <string>

#include "apps/view/picture_maker.h"

namespace freevoxels {

/// The command line that makes the picture again, into `file`.
std::string commandOf(const Picture& picture, const std::string& file);
/// The one of a full turn that starts with it, or, where the camera is left to the volume, frames the volume
/// in all of its frames.
std::string turnCommandOf(const Picture& picture, const std::string& pattern, int frames);

/// Of a picture on this device into an .exr or a .png, with all that `freevoxels render` would write. Fails as that does.
void savePicture(const Device& device, const Picture& picture, const std::string& file);
/// What `freevoxels render --save-scene` writes.
void saveScene(const Picture& picture, const std::string& file);
/// The frames that turnCommandOf's command makes.
void saveTurn(const Device& device, const Picture& picture, const std::string& pattern, int frames,
              const Progress& progress);

}  // namespace freevoxels
