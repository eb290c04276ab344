#pragma once
// The images that a command writes, their form chosen by extension.

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/common/option_values.h"
#include "engine/description/scene_description.h"
#include "engine/image/image.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// The name of the output that is standard output: a .png.
inline constexpr std::string_view kStandardOutput = "-";
/// Whether an image is written there, so that nothing else may be.
bool usesStandardOutput(std::span<const std::string> files);

/// Whether the name of a file has the extension of a format, in upper or lower case.
bool isExr(const std::string& file);
bool isPng(const std::string& file);
bool isJpeg(const std::string& file);
/// Any of them.
bool isImage(const std::string& file);

/// Whether the output field of a scene affects any of the files; other fields always count.
bool honours(std::span<const std::string> files, std::string_view field);
/// The fields of the output that affect any of the files.
OutputDescription honoured(const OutputDescription& output, std::span<const std::string> files);
/// Checks extensions and fields that no output can honour (ErrorKind::Usage), folders, and that no terminal is sent an image
/// (ErrorKind::Output). To be called before any work.
void checkOutputs(const OutputDescription& output, std::span<const std::string> files);
/// Writes each file completely or not at all, and to standard output one image after another.
void writeImages(const Image& image, const OutputDescription& output, std::span<const std::string> files, const ExrOptions& exr);

/// Makes pixels black of which some number is NaN or infinite, which light beyond the range of single precision makes of them. A sentence
/// that says so; empty if there are none.
std::string clearPixelsThatAreNoNumbers(Image& image);

/// Prints the names of images that are complete, unless one is written to standard output.
void printNames(std::span<const std::string> files);

/// The metadata of an EXR: "freevoxels:NAME" for every option, the command that makes it again as image.exr,
/// versions, the device, and the camera's matrices. Contains nothing that differs between two runs of a
/// command, nor the file's name. `command` is its name, such as "render".
ExrOptions exrMetadata(const std::string& command, const OptionList& options, const std::map<std::string, std::string>& facts,
                       const Camera& camera, double aspect);

/// The words of a command that writes one file, for a shell: OUT stands behind IN.
std::string commandInto(const std::string& command, OptionList options, const std::string& file);

}  // namespace freevoxels
