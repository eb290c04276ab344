#pragma once
// Exports of an image: the files and command lines of `freevoxels render` and `turntable`.

#include <optional>
#include <string>
#include <string_view>

#include "apps/common/sequence.h"
#include "apps/view/image_maker.h"

namespace freevoxels {

/// Breaks a command into lines of at most `columns` characters: between words, or inside words that are
/// longer and not quoted. A shell reads the lines as the same command.
std::string wrappedCommand(std::string_view command, std::size_t columns);

/// The command line that makes the image again, into `file`.
std::string commandOf(const DrawnImage& drawn, const std::string& file);
/// Frames that are drawn of a scene with a camera that moves.
struct MovedFrames {
  std::string pattern;  ///< of the names of files
  int frames = 1;
  /// CameraDescription::flight; else a full turn that starts with the image, or, if the camera is automatic, fills all frames with the
  /// volume.
  std::optional<std::string> flight;
};

/// The command line of these frames.
std::string commandOf(const DrawnImage& drawn, const MovedFrames& moved);

/// Writes an image of this device with all that `freevoxels render` would write. Fails as that does.
void saveImage(const Device& device, const DrawnImage& drawn, const std::string& file);
/// Draws the same view with another number of pixels, and writes that.
void saveImageOfSize(const Device& device, const DrawnImage& drawn, glm::ivec2 size, const std::string& file, const Progress& progress);
/// Whether a program is installed that puts images into the clipboard: wl-copy under Wayland, xclip under X11.
bool canCopyImages();
/// Calls this program with the image as a PNG. Fails with ErrorKind::Output if the program does.
void copyImage(const Device& device, const DrawnImage& drawn);
/// Writes the scene as `freevoxels render --save-scene` does.
void saveScene(const DrawnImage& drawn, const std::string& file);
/// Writes the frames of that command.
void saveMoved(const Device& device, const DrawnImage& drawn, const MovedFrames& moved, const Progress& progress);

/// Writes an image of each frame of the sequence, with the camera, lights and scales of the image. Frames without anything to draw are the
/// background.
void saveSequence(const Device& device, const DrawnImage& drawn, const Sequence& sequence, const std::string& pattern,
                  const Progress& progress);

}  // namespace freevoxels
