#include "apps/freevoxels/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <span>

#include "apps/common/share_options.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/image/fixed_sums.h"

namespace freevoxels {

namespace {

constexpr const char* kMergeExamples =
    "PARTs are written by 'freevoxels render --share I/N --sums'; the first name that is no such file, and all behind it, are images "
    "to\nwrite. Parts of different N can be mixed, as long as they have each share once.\n"
    "Examples:\n"
    "  freevoxels render cloud.vdb part_0.exr --share 0/2 --sums\n"
    "  freevoxels render cloud.vdb part_1.exr --share 1/2 --sums\n"
    "  freevoxels merge part_0.exr part_1.exr cloud.png cloud.exr\n";

/// Header entries in which parts of one image may differ: where they were drawn, from which copy of the volume, and their shares.
const std::set<std::string> kMayDiffer{"freevoxels:share", "freevoxels:command", "freevoxels:device", "freevoxels:driver",
                                       "freevoxels:input", "freevoxels:volume"};

std::string valueOf(const ExrOptions& header, const std::string& name) {
  const auto entry = header.metadata.find(name);
  return entry == header.metadata.end() ? "" : entry->second;
}

/// A value of a header in a form that fits into a sentence.
std::string shown(const std::string& value) {
  constexpr std::size_t kLongest = 200;
  return value.empty() ? "missing" : printablePart(value, kLongest);
}

/// Fails where the header says something else of a part than its sums.
void checkHeader(const std::string& file, const SumsFile& part) {
  const std::string size = valueOf(part.header, "freevoxels:size"), actual = fmt::format("{}x{}", part.sums.size.x, part.sums.size.y);
  if (!size.empty() && size != actual)
    fail(ErrorKind::Input, "'{}' has sums of {} pixels, and its header says {}; render this share again", file, actual, shown(size));
}

/// The parts that were added so far, and the file that each share came from.
class Merge {
 public:
  void add(const std::string& file);
  /// Fails where shares are missing.
  void checkComplete() const;
  const FixedSums& sums() const { return total_.sums; }
  const ExrOptions& header() const { return total_.header; }

 private:
  void checkSameImage(const std::string& file, const SumsFile& part) const;

  std::string firstFile_;
  SumsFile total_;
  std::array<std::string, kShares> fileOfShare_;
  int leastCount_ = kShares;  ///< of the N of the parts
};

void Merge::checkSameImage(const std::string& file, const SumsFile& part) const {
  const auto refuse = [&](const std::string& what) {
    fail(ErrorKind::Input, "'{}' and '{}' are parts of different images: {}; render one of them again", firstFile_, file, what);
  };
  const auto compare = [&](const std::string& name, const std::string& what) {
    const std::string mine = valueOf(total_.header, name), other = valueOf(part.header, name);
    if (mine != other) refuse(fmt::format("{} is {} in one and {} in the other", what, shown(mine), shown(other)));
  };
  compare("freevoxels:version", "the version of freevoxels");
  if (valueOf(total_.header, "freevoxels:content") != valueOf(part.header, "freevoxels:content"))
    refuse(fmt::format("their volumes, {} and {}, or their transfer functions or environments, are not the same",
                       shown(valueOf(total_.header, "freevoxels:volume")), shown(valueOf(part.header, "freevoxels:volume"))));
  std::set<std::string> names;
  for (const ExrOptions* header : {&total_.header, &part.header})
    for (const auto& [name, value] : header->metadata) names.insert(name);
  for (const std::string& name : names)
    if (!kMayDiffer.contains(name)) compare(name, "--" + shown(name.substr(name.find(':') + 1)));
  if (total_.header.matrices != part.header.matrices) refuse("their cameras are not the same");
  if (!total_.sums.isLike(part.sums)) refuse("their rectangles or numbers of digits are not the same");
}

void Merge::add(const std::string& file) {
  SumsFile part = readSums(file);
  checkHeader(file, part);
  const SharePart shares = readSharePart(fmt::format("the share of '{}'", file), valueOf(part.header, "freevoxels:share"));
  if (firstFile_.empty())
    firstFile_ = file;
  else
    checkSameImage(file, part);
  leastCount_ = std::min(leastCount_, shares.count);
  for (int share = 0; share < kShares; ++share) {
    if (!shares.holds(share)) continue;
    std::string& other = fileOfShare_[std::size_t(share)];
    if (!other.empty())
      fail(ErrorKind::Input, "'{}' and '{}' have the same shares, {}: leave one of them out", other, file, sharePartText(shares));
    other = file;
  }
  if (firstFile_ == file) {
    total_ = std::move(part);
    return;
  }
  if (!total_.sums.canAdd(part.sums)) fail(ErrorKind::Input, "'{}' has sums that are too large to be added; render this share again", file);
  total_.sums += part.sums;
}

void Merge::checkComplete() const {
  const auto isMissing = [&](const SharePart& part) {
    for (int share = part.first(); share < part.end(); ++share)
      if (!fileOfShare_[std::size_t(share)].empty()) return false;
    return true;
  };
  if (std::ranges::none_of(fileOfShare_, &std::string::empty)) return;
  // The largest part of which nothing is there; one of kShares parts is a single share.
  for (SharePart part{.count = leastCount_}; part.count <= kShares; ++part.count)
    for (part.index = 0; part.index < part.count; ++part.index)
      if (isMissing(part))
        fail(ErrorKind::Input, "share {} is missing: render it with --share {} --sums", sharePartText(part), sharePartText(part));
}

ExrOptions imageHeaderOf(const Merge& merge, const OutputDescription& output) {
  ExrOptions header = merge.header();
  header.metadata["freevoxels:share"] = sharePartText({});
  for (const char* ofSums : {"freevoxels:method", "freevoxels:lattice"}) header.metadata.erase(ofSums);
  header.fullFloat = output.fullFloat;
  return header;
}

}  // namespace

void MergeCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("merge", "Add up the parts of an image that were rendered share by share");
  command->add_option("FILES", files_, "PART... OUT...: files of sums, then images to write, .exr (linear, premultiplied) or .png (sRGB)")
      ->required();
  scene_.addSection(*command, "output");
  messages_.add(*command);
  command->footer(kMergeExamples);
  command->callback([this] { run(); });
}

void MergeCommand::run() const {
  messages_.apply();
  checkDistinct(files_);
  const auto isPart = [](const std::string& file) {
    std::error_code error;
    return isExr(file) && std::filesystem::is_regular_file(file, error) && holdsSums(file);
  };
  const auto firstOutput = std::ranges::find_if_not(files_, isPart);
  if (firstOutput == files_.begin())
    fail(ErrorKind::Usage, "'{}' is no file of sums: name the files that 'freevoxels render --share I/N --sums' wrote, then images",
         files_.front());
  if (firstOutput == files_.end()) fail(ErrorKind::Usage, "OUT is required: name an image to write behind the parts, .exr or .png");
  const OutputDescription& output = scene_.description.output;
  const std::span<const std::string> images = std::span(files_).subspan(std::size_t(firstOutput - files_.begin()));
  for (const std::string& file : images)
    if (isPart(file)) fail(ErrorKind::Usage, "'{}' holds sums and would be replaced: name all parts before the images", file);
  checkOutputs(output, images);

  Merge merge;
  for (const std::string& file : std::span(files_).first(std::size_t(firstOutput - files_.begin()))) merge.add(file);
  merge.checkComplete();
  if (output.aovs.needDepth() && merge.sums().channels < kSumChannels)
    fail(ErrorKind::Input, "the parts have no distances, which --aov depth needs: render them with --aov depth too");
  writeImages(resolveSums(merge.sums(), valueOf(merge.header(), "freevoxels:composite") != "additive"), output, images,
              imageHeaderOf(merge, output));
  if (messages_.quiet) return;
  printNames(images);
}

}  // namespace freevoxels
