#pragma once
// The pictures that a command writes, their form chosen by extension.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/freevoxels/option_values.h"
#include "engine/image/image.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// By extension, in any case.
bool isExr(const std::string& file);
bool isPng(const std::string& file);

/// In the order of ToneMap.
inline const std::vector<std::string> kToneMapWords{"none", "filmic", "aces"};

struct OutputOptions {
  std::vector<std::string> files;
  std::optional<glm::dvec3> background;  ///< none: a dark gradient, unless `transparent`
  bool transparent = false;
  std::optional<double> exposure;
  std::optional<int> toneMap;  ///< ToneMap
  bool fullFloat = false;
  std::optional<int> aov;

  void add(CLI::App& app);
  /// How they are written, without OUT.
  void addForm(CLI::App& app);
  /// Whether the option, "--float", changes any of the files.
  bool honours(const std::string& option) const;
  /// Leaves out what changes none of the files.
  void leaveOutUnhonoured();
  /// Before any work: extensions, options that no output can honour (ExitCode::Usage), folders
  /// (ExitCode::Output).
  void check() const;
  /// How a .png is made of a picture.
  DisplayLook look() const;
  bool wantsDepth() const { return aov.has_value(); }
  void describe(OptionList& options) const;
  /// Writes each file completely or not at all.
  void write(const Image& image, const ExrOptions& exr) const;
};

/// What an EXR says of its making: "freevoxels:NAME" for every option, the command without its outputs,
/// versions, the device; and its camera's matrices. Holds nothing that differs between two runs of a command.
/// `command` is its name, "render".
ExrOptions exrMetadata(const std::string& command, const OptionList& options,
                       const std::map<std::string, std::string>& facts, const Camera& camera, double aspect);

}  // namespace freevoxels
