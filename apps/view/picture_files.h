#pragma once
// Exports of an image: the files and command lines of `freevoxels render` and `turntable`.

#include <string>

#include "apps/view/picture_maker.h"

namespace freevoxels {

/// The command line that makes the image again, into `file`.
std::string commandOf(const Picture& picture, const std::string& file);
/// The command line of a full turn that starts with the image, or, if the camera is automatic, fills all
/// frames with the volume.
std::string turnCommandOf(const Picture& picture, const std::string& pattern, int frames);

/// Of a picture on this device into an .exr or a .png, with all that `freevoxels render` would write. Fails as that does.
void savePicture(const Device& device, const Picture& picture, const std::string& file);
/// Writes the scene as `freevoxels render --save-scene` does.
void saveScene(const Picture& picture, const std::string& file);
/// Writes the frames of turnCommandOf's command.
void saveTurn(const Device& device, const Picture& picture, const std::string& pattern, int frames,
              const Progress& progress);

}  // namespace freevoxels
