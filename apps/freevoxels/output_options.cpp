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

bool isJpeg(const std::string& file) {
  return extensionOf(file) == ".jpg" || extensionOf(file) == ".jpeg";
}

bool isImage(const std::string& file) {
  return isExr(file) || isPng(file) || isJpeg(file);
}

void OutputOptions::add(CLI::App& app) {
  app.add_option("OUT,-o,--output", files,
                 "Images to write: .exr (linear, premultiplied), .png or .jpg (sRGB) [the volume's name .png, in the current folder]");
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
         "Colour behind the volume in a .png or .jpg, linear, or transparent [a dark gradient]")
      ->take_last()
      ->type_name("R,G,B|transparent")
      ->group(kGroup);
  addNumber(app, "--exposure", "EV", exposure, "Stops that a .png or .jpg is brightened by [0]", {-20.0, 20.0})->group(kGroup);
  addWord(app, "--tone-map", kToneMapWords, toneMap, "How bright light is brought into the range of a .png or .jpg [none: it is clipped]")
      ->group(kGroup);
  app.add_flag("--float", fullFloat, "Write 32-bit floats to an .exr [16-bit]")->group(kGroup);
  addWord(app, "--png-bits", kPngBitsWords, pngBits, "Bits a channel in a .png [8]")->group(kGroup);
  app.add_option_function<std::string>(
         "--aov", [this](const std::string& text) { aovs = readAovs("--aov", text); },
         "Adds channels to an .exr, of depth, position, normal and transmittance, with commas between them: Z, the mean distance "
         "along the viewing axis; P, the point there in the world; N, its normal; transmittance.Y, 1 - alpha")
      ->take_last()
      ->type_name("LIST")
      ->group(kGroup);
  app.add_option_function<std::string>(
         "--crop",
         [this](const std::string& text) {
           constexpr int kLargest = 1 << 20;  // beyond any image: checkCrop has the sentence for those
           const std::vector<double> numbers =
               readNumbers("--crop", "X,Y,W,H", 4, text, {.minimum = 0.0, .maximum = double(kLargest)});
           crop = PixelRectangle{{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
         },
         "Writes only these pixels of the image: column and row of the top left one, width and height; the whole image is drawn")
      ->take_last()
      ->type_name("X,Y,W,H")
      ->group(kGroup);
}

bool OutputOptions::honours(const std::string& option) const {
  if (option == "--background" || option == "--exposure" || option == "--tone-map")
    return std::ranges::any_of(files, [](const std::string& file) { return isPng(file) || isJpeg(file); });
  if (option == "--png-bits") return std::ranges::any_of(files, isPng);
  return (option != "--aov" && option != "--float") || std::ranges::any_of(files, isExr);
}

void OutputOptions::leaveOutUnhonoured() {
  if (!honours("--background")) {
    background.reset();
    exposure.reset();
    toneMap.reset();
    transparent = false;
  }
  if (!honours("--png-bits")) pngBits.reset();
  if (!honours("--aov")) aovs = {};
  fullFloat = fullFloat && honours("--float");
}

void OutputOptions::check() const {
  for (const std::string& file : files)
    if (!isImage(file))
      fail(ErrorKind::Usage, "'{}' has no known image extension; name it .exr, .png or .jpg", file);
  if (aovs.any() && !honours("--aov")) fail(ErrorKind::Usage, "--aov {} needs an .exr output", aovText(aovs));
  if (fullFloat && !honours("--float")) fail(ErrorKind::Usage, "--float needs an .exr output");
  if (pngBits && !honours("--png-bits")) fail(ErrorKind::Usage, "--png-bits needs a .png output");
  if ((background || transparent) && !honours("--background"))
    fail(ErrorKind::Usage, "--background needs a .png or .jpg output: an .exr keeps its alpha");
  if (transparent && std::ranges::any_of(files, isJpeg))
    fail(ErrorKind::Usage, "--background transparent needs .png outputs: a .jpg has no alpha");
  if ((exposure || toneMap) && !honours("--exposure"))
    fail(ErrorKind::Usage, "{} needs a .png or .jpg output: an .exr keeps linear light", exposure ? "--exposure" : "--tone-map");
  for (const std::string& file : files) checkOutput(file);
}

void OutputOptions::checkCrop(glm::ivec2 imageSize) const {
  if (!crop) return;
  const glm::ivec2 end = crop->corner + crop->size;
  if (crop->size.x < 1 || crop->size.y < 1 || end.x > imageSize.x || end.y > imageSize.y)
    fail(ErrorKind::Usage, "--crop {},{},{},{} is no part of an image of {}x{} pixels", crop->corner.x, crop->corner.y, crop->size.x,
         crop->size.y, imageSize.x, imageSize.y);
}

void OutputOptions::describe(OptionList& options) const {
  if (background) options.emplace_back("--background", numberText(*background));
  if (transparent) options.emplace_back("--background", "transparent");
  if (exposure) options.emplace_back("--exposure", numberText(*exposure));
  if (toneMap) options.emplace_back("--tone-map", kToneMapWords[std::size_t(*toneMap)]);
  if (fullFloat) options.emplace_back("--float", "");
  if (pngBits) options.emplace_back("--png-bits", kPngBitsWords[std::size_t(*pngBits)]);
  if (aovs.any()) options.emplace_back("--aov", aovText(aovs));
  if (crop)
    options.emplace_back("--crop", fmt::format("{},{},{},{}", crop->corner.x, crop->corner.y, crop->size.x, crop->size.y));
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

void OutputOptions::write(const Image& whole, const ExrOptions& exr) const {
  checkCrop(whole.size);
  const std::optional<Image> part = crop ? std::optional(cropped(whole, *crop)) : std::nullopt;
  const Image& image = part ? *part : whole;
  for (const std::string& file : files) {
    const DeferredInterrupts wholeFiles;
    if (isExr(file))
      writeExr(file, image, exr);
    else if (isJpeg(file))
      writeJpeg(file, image, look());
    else
      writePng(file, image, look(), pngBits.value_or(0) == 1 ? 16 : 8);
  }
}

std::string commandInto(const std::string& command, OptionList options, const std::string& file) {
  options.insert(options.begin() + 1, {"", file});
  return "freevoxels " + command + " " + commandText(options);
}

ExrOptions exrMetadata(const std::string& command, const OptionList& options,
                       const std::map<std::string, std::string>& facts, const Camera& camera, double aspect) {
  ExrOptions exr;
  for (const auto& [name, value] : facts) exr.metadata["freevoxels:" + name] = value;
  for (const auto& [name, value] : optionMap(options)) exr.metadata["freevoxels:" + name] = value;
  exr.metadata["freevoxels:command"] = commandInto(command, options, "image.exr");
  exr.metadata["freevoxels:version"] = programVersion();
  exr.matrices["worldToCamera"] = glm::mat4(worldToCamera(camera));
  exr.matrices["worldToNDC"] = glm::mat4(worldToNdc(camera, aspect));
  return exr;
}

}  // namespace freevoxels
