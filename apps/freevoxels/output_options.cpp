#include "apps/freevoxels/output_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "apps/freevoxels/program.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr const char* kGroup = "Output";

std::string extensionOf(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

}  // namespace

bool isExr(const std::string& file) {
  return extensionOf(file) == ".exr";
}

bool isPng(const std::string& file) {
  return extensionOf(file) == ".png";
}

void OutputOptions::add(CLI::App& app) {
  app.add_option("OUT", files,
                 "Pictures to write: .exr (linear, premultiplied) or .png (sRGB, straight alpha)");
  addForm(app);
}

void OutputOptions::addForm(CLI::App& app) {
  addTriple(app, "--background", "R,G,B", background,
            "Colour behind the volume in a .png, linear [transparent]", {0.0, 1.0})
      ->group(kGroup);
  app.add_flag("--float", fullFloat, "32 bits a channel in an .exr [16]")->group(kGroup);
  addWord(app, "--aov", {"depth"}, aov,
          "Adds the channel Z, mean distance along the viewing axis, to an .exr")
      ->group(kGroup);
}

bool OutputOptions::honours(const std::string& option) const {
  if (option == "--background") return std::ranges::any_of(files, isPng);
  return (option != "--aov" && option != "--float") || std::ranges::any_of(files, isExr);
}

void OutputOptions::leaveOutUnhonoured() {
  if (!honours("--background")) background.reset();
  if (!honours("--aov")) aov.reset();
  fullFloat = fullFloat && honours("--float");
}

void OutputOptions::check() const {
  for (const std::string& file : files)
    if (!isExr(file) && !isPng(file))
      fail(ExitCode::Usage, "'{}' has no known picture extension; name it .exr or .png", file);
  if (wantsDepth() && !honours("--aov")) fail(ExitCode::Usage, "--aov depth needs an .exr output");
  if (fullFloat && !honours("--float")) fail(ExitCode::Usage, "--float needs an .exr output");
  if (background && !honours("--background"))
    fail(ExitCode::Usage, "--background needs a .png output: an .exr keeps its alpha");
  for (const std::string& file : files) checkOutput(file);
}

void OutputOptions::describe(OptionList& options) const {
  if (background) options.emplace_back("--background", numberText(*background));
  if (fullFloat) options.emplace_back("--float", "");
  if (wantsDepth()) options.emplace_back("--aov", "depth");
}

void OutputOptions::write(const Image& image, const ExrOptions& exr) const {
  for (const std::string& file : files) {
    const DeferredInterrupts wholeFiles;
    if (isExr(file)) {
      writeExr(file, image, exr);
    } else {
      const glm::vec3 color(background.value_or(glm::dvec3(0.0)));
      writePng(file, image, background ? &color : nullptr);
    }
  }
}

ExrOptions exrMetadata(const std::string& command, const OptionList& options,
                       const std::map<std::string, std::string>& facts, const Camera& camera, double aspect) {
  ExrOptions exr;
  for (const auto& [name, value] : facts) exr.metadata["freevoxels:" + name] = value;
  for (const auto& [name, value] : optionMap(options)) exr.metadata["freevoxels:" + name] = value;
  exr.metadata["freevoxels:command"] = "freevoxels " + command + " " + commandText(options);
  exr.metadata["freevoxels:version"] = programVersion();
  exr.matrices["worldToCamera"] = glm::mat4(worldToCamera(camera));
  exr.matrices["worldToNDC"] = glm::mat4(worldToNdc(camera, aspect));
  return exr;
}

}  // namespace freevoxels
