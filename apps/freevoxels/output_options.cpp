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
  app.add_option("OUT,-o,--output", files,
                 "Pictures to write: .exr (linear, premultiplied) or .png (sRGB) [the volume's name .png, in the current folder]");
  addForm(app);
}

void OutputOptions::addForm(CLI::App& app) {
  app.add_option_function<std::string>(
         "--background",
         [this](const std::string& text) {
           background.reset();
           transparent = text == "transparent";
           if (transparent) return;
           const auto numbers = readNumbers("--background", "R,G,B or transparent", 3, text, {.minimum = 0.0, .maximum = 1.0});
           background = glm::dvec3(numbers[0], numbers[1], numbers[2]);
         },
         "Colour behind the volume in a .png, linear, or transparent [a dark gradient]")
      ->take_last()
      ->type_name("R,G,B|transparent")
      ->group(kGroup);
  addNumber(app, "--exposure", "EV", exposure, "Stops that a .png is brightened by [0]", {-20.0, 20.0})->group(kGroup);
  addWord(app, "--tone-map", kToneMapWords, toneMap, "How bright light is brought into the range of a .png [none: it is clipped]")
      ->group(kGroup);
  app.add_flag("--float", fullFloat, "32 bits a channel in an .exr [16]")->group(kGroup);
  addWord(app, "--aov", {"depth"}, aov,
          "Adds the channel Z, mean distance along the viewing axis, to an .exr")
      ->group(kGroup);
}

bool OutputOptions::honours(const std::string& option) const {
  if (option == "--background" || option == "--exposure" || option == "--tone-map") return std::ranges::any_of(files, isPng);
  return (option != "--aov" && option != "--float") || std::ranges::any_of(files, isExr);
}

void OutputOptions::leaveOutUnhonoured() {
  if (!honours("--background")) {
    background.reset();
    exposure.reset();
    toneMap.reset();
    transparent = false;
  }
  if (!honours("--aov")) aov.reset();
  fullFloat = fullFloat && honours("--float");
}

void OutputOptions::check() const {
  for (const std::string& file : files)
    if (!isExr(file) && !isPng(file))
      fail(ExitCode::Usage, "'{}' has no known picture extension; name it .exr or .png", file);
  if (wantsDepth() && !honours("--aov")) fail(ExitCode::Usage, "--aov depth needs an .exr output");
  if (fullFloat && !honours("--float")) fail(ExitCode::Usage, "--float needs an .exr output");
  if ((background || transparent) && !honours("--background"))
    fail(ExitCode::Usage, "--background needs a .png output: an .exr keeps its alpha");
  if ((exposure || toneMap) && !honours("--exposure"))
    fail(ExitCode::Usage, "{} needs a .png output: an .exr keeps linear light", exposure ? "--exposure" : "--tone-map");
  for (const std::string& file : files) checkOutput(file);
}

void OutputOptions::describe(OptionList& options) const {
  if (background) options.emplace_back("--background", numberText(*background));
  if (transparent) options.emplace_back("--background", "transparent");
  if (exposure) options.emplace_back("--exposure", numberText(*exposure));
  if (toneMap) options.emplace_back("--tone-map", kToneMapWords[std::size_t(*toneMap)]);
  if (fullFloat) options.emplace_back("--float", "");
  if (wantsDepth()) options.emplace_back("--aov", "depth");
}

DisplayLook OutputOptions::look() const {
  constexpr Background kDark{.top = {0.028f, 0.031f, 0.038f}, .bottom = {0.007f, 0.008f, 0.01f}};
  DisplayLook look{.exposure = exposure.value_or(0.0), .toneMap = ToneMap(toneMap.value_or(int(ToneMap::None)))};
  if (background)
    look.background = Background{.top = *background, .bottom = *background};
  else if (!transparent)
    look.background = kDark;
  return look;
}

void OutputOptions::write(const Image& image, const ExrOptions& exr) const {
  for (const std::string& file : files) {
    const DeferredInterrupts wholeFiles;
    if (isExr(file)) {
      writeExr(file, image, exr);
    } else {
      writePng(file, image, look());
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
