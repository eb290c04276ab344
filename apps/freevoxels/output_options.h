#pragma once
// The images that a command writes, their form chosen by extension.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/freevoxels/aov.h"
#include "apps/freevoxels/option_values.h"
#include "engine/image/image.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// By extension, in any case.
bool isExr(const std::string& file);
bool isPng(const std::string& file);
bool isJpeg(const std::string& file);
/// Any of them.
bool isImage(const std::string& file);

/// What --png-bits takes.
inline const std::vector<std::string> kPngBitsWords{"8", "16"};

/// In the order of ToneMap.
inline const std::vector<std::string> kToneMapWords{"none", "filmic", "aces"};

struct OutputOptions {
  std::vector<std::string> files;
  std::optional<glm::dvec3> background;  ///< if there is none, a dark gradient, unless `transparent`
  bool transparent = false;
  std::optional<double> exposure;
  std::optional<int> toneMap;  ///< ToneMap
  bool fullFloat = false;
  std::optional<int> pngBits;  ///< index into kPngBitsWords
  Aovs aovs;
  std::optional<PixelRectangle> crop;

  void add(CLI::App& app);
  /// Adds the options without OUT.
  void addForm(CLI::App& app);
  /// Whether an option such as "--float" affects any of the files.
  bool honours(const std::string& option) const;
  /// Drops the options that affect none of the files.
  void leaveOutUnhonoured();
  /// Checks extensions and options that no output can honour (ErrorKind::Usage), and folders
  /// (ErrorKind::Output). To be called before any work.
  void check() const;
  /// ErrorKind::Usage where --crop is not inside an image of this size.
  void checkCrop(glm::ivec2 imageSize) const;
  /// How a .png or a .jpg is made of an image.
  DisplayLook look() const;
  /// Whether the image must be drawn with its depth.
  bool wantsDepth() const { return aovs.needDepth(); }
  void describe(OptionList& options) const;
  /// Writes each file completely or not at all.
  void write(const Image& image, const ExrOptions& exr) const;
};

/// The metadata of an EXR: "freevoxels:NAME" for every option, the command that makes it again as image.exr,
/// versions, the device, and the camera's matrices. Contains nothing that differs between two runs of a
/// command, nor the file's name. `command` is its name, such as "render".
ExrOptions exrMetadata(const std::string& command, const OptionList& options,
                       const std::map<std::string, std::string>& facts, const Camera& camera, double aspect);

/// The words of a command that writes one file, for a shell: OUT stands behind IN.
std::string commandInto(const std::string& command, OptionList options, const std::string& file);

}  // namespace freevoxels
