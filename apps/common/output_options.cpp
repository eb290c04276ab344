#include "apps/common/output_options.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "apps/common/program.h"
#include "engine/core/error.h"
#include "engine/description/scene_fields.h"

namespace freevoxels {

namespace {

constexpr std::size_t kPixelsATask = std::size_t(1) << 16;

std::string extensionOf(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

int pngBits(const OutputDescription& output) {
  return output.pngBits == PngBits::Sixteen ? 16 : 8;
}

void writeToStandardOutput(const Image& image, const OutputDescription& output) {
  const std::vector<std::uint8_t> bytes = encodePng(image, output.look(), pngBits(output));
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
    fail(ErrorKind::Output, "cannot write the image to standard output: its reader has ended, or the disk is full");
}

}  // namespace

bool usesStandardOutput(std::span<const std::string> files) {
  return std::ranges::find(files, kStandardOutput) != files.end();
}

bool isExr(const std::string& file) {
  return extensionOf(file) == ".exr";
}

bool isPng(const std::string& file) {
  return extensionOf(file) == ".png" || file == kStandardOutput;
}

bool isJpeg(const std::string& file) {
  return extensionOf(file) == ".jpg" || extensionOf(file) == ".jpeg";
}

bool isImage(const std::string& file) {
  return isExr(file) || isPng(file) || isJpeg(file);
}

bool honours(std::span<const std::string> files, std::string_view field) {
  if (field == "background" || field == "exposure" || field == "tone-map")
    return std::ranges::any_of(files, [](const std::string& file) { return isPng(file) || isJpeg(file); });
  if (field == "png-bits") return std::ranges::any_of(files, isPng);
  return (field != "aov" && field != "float") || std::ranges::any_of(files, isExr);
}

OutputDescription honoured(const OutputDescription& output, std::span<const std::string> files) {
  return partOf({.output = output}, [&](const SceneField& field) { return honours(files, field.name); }).output;
}

void checkOutputs(const OutputDescription& output, std::span<const std::string> files) {
  for (const std::string& file : files)
    if (!isImage(file))
      fail(ErrorKind::Usage, "'{}' has no known image extension; name it .exr, .png or .jpg, or - for a .png on standard output", file);
  const auto needs = [&](bool given, const char* field) { return given && !honours(files, field); };
  if (needs(output.aovs.any(), "aov")) fail(ErrorKind::Usage, "{} needs an .exr output", Parameter("aov", aovText(output.aovs)));
  if (needs(output.fullFloat, "float")) fail(ErrorKind::Usage, "{} needs an .exr output", Parameter("float"));
  if (needs(output.pngBits.has_value(), "png-bits")) fail(ErrorKind::Usage, "{} needs a .png output", Parameter("png-bits"));
  if (needs(output.background || output.transparent, "background"))
    fail(ErrorKind::Usage, "{} needs a .png or .jpg output: an .exr keeps its alpha", Parameter("background"));
  if (output.transparent && std::ranges::any_of(files, isJpeg))
    fail(ErrorKind::Usage, "{} needs .png outputs: a .jpg has no alpha", Parameter("background", "transparent"));
  if (needs(output.exposure || output.toneMap, "exposure"))
    fail(ErrorKind::Usage, "{} needs a .png or .jpg output: an .exr keeps linear light",
         Parameter(output.exposure ? "exposure" : "tone-map"));
  if (usesStandardOutput(files) && isatty(STDOUT_FILENO) == 1)
    fail(ErrorKind::Output, "'-' sends the image to a terminal: append > FILE.png, or | and a program that reads a .png");
  for (const std::string& file : files)
    if (file != kStandardOutput) checkOutput(file);
}

void writeImages(const Image& whole, const OutputDescription& output, std::span<const std::string> files, const ExrOptions& exr) {
  output.checkCrop(whole.size);
  const std::optional<Image> part = output.crop ? std::optional(cropped(whole, *output.crop)) : std::nullopt;
  const Image& image = part ? *part : whole;
  for (const std::string& file : files) {
    const DeferredInterrupts wholeFiles;
    if (isExr(file))
      writeExr(file, image, exr);
    else if (isJpeg(file))
      writeJpeg(file, image, output.look());
    else if (file == kStandardOutput)
      writeToStandardOutput(image, output);
    else
      writePng(file, image, output.look(), pngBits(output));
  }
}

std::string clearPixelsThatAreNoNumbers(Image& image) {
  std::atomic<std::size_t> cleared = 0;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, image.pixels.size(), kPixelsATask),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        glm::vec4& pixel = image.pixels[i];
                        if (std::isfinite(pixel.r + pixel.g + pixel.b + pixel.a)) continue;
                        pixel = glm::vec4(0.0f);
                        ++cleared;
                      }
                    });
  if (cleared == 0) return "";
  return fmt::format("{} pixels are beyond the range of numbers and become black: use less extreme lights, emission and distances",
                     cleared.load());
}

void printNames(std::span<const std::string> files) {
  if (usesStandardOutput(files)) return;
  for (const std::string& file : files) fmt::print("{}\n", file);
  std::fflush(stdout);
}

std::string commandInto(const std::string& command, OptionList options, const std::string& file) {
  options.insert(options.begin() + 1, {"", file});
  return "freevoxels " + command + " " + commandText(options);
}

ExrOptions exrMetadata(const std::string& command, const OptionList& options, const std::map<std::string, std::string>& facts,
                       const Camera& camera, double aspect) {
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
