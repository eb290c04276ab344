#include "apps/common/share_options.h"

#include <CLI/CLI.hpp>
#include <charconv>

#include "engine/core/error.h"
#include "engine/core/printable.h"

namespace freevoxels {

namespace {

constexpr const char* kGroup = "Cluster";

}  // namespace

SharePart readSharePart(const std::string& name, const std::string& text) {
  SharePart part;
  const char* const end = text.data() + text.size();
  const auto [slash, indexError] = std::from_chars(text.data(), end, part.index);
  if (indexError == std::errc() && slash != end && *slash == '/') {
    const auto [last, countError] = std::from_chars(slash + 1, end, part.count);
    if (countError == std::errc() && last == end && 0 <= part.index && part.index < part.count && part.count <= kShares) return part;
  }
  constexpr std::size_t kLongest = 80;
  fail(ErrorKind::Usage, "{} takes I/N with 0 <= I < N <= {}, as 0/4, not '{}'", name, kShares, printablePart(text, kLongest));
}

std::string sharePartText(const SharePart& part) {
  return fmt::format("{}/{}", part.index, part.count);
}

void ShareOptions::add(CLI::App& app) {
  app.add_option_function<std::string>(
         "--share", [this](const std::string& text) { part = readSharePart("--share", text); },
         "Draw part I of N alone: some rows of the image, or with --draw splats some of the volume's blocks; the parts I = 0 to N - 1 are "
         "the "
         "whole, with the same bits for every N")
      ->take_last()
      ->type_name("I/N")
      ->group(kGroup);
  app.add_flag("--sums", sums, "Write the sums of the part, an .exr that 'freevoxels merge' adds up with the others, instead of an image")
      ->group(kGroup);
  addWholeNumber(app, "--color-parts", "N", coloredParts, "Show how N processes divide a frame: give what each draws a colour of its own",
                 {1.0, double(kShares)})
      ->group(kGroup);
}

void ShareOptions::check() const {
  if (coloredParts && (part || sums)) fail(ErrorKind::Usage, "--color-parts shows all parts in one image: leave --share and --sums out");
}

void checkRanks(int ranks) {
  if (ranks > kShares)
    fail(ErrorKind::Usage, "{} ranks are more than the {} shares that a frame is divided into: start {} or fewer", ranks, kShares, kShares);
}

FrameSettings sharedSettings(FrameSettings settings) {
  if (settings.isSorted()) fail(ErrorKind::Usage, "a sorted image cannot be divided into shares: leave --composite sorted out");
  return settings;
}

}  // namespace freevoxels
