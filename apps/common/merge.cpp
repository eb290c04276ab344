#include "apps/common/merge.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "apps/common/output_options.h"
#include "apps/common/share_options.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/image/fixed_sums.h"

namespace freevoxels {

namespace {

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

bool isPartOfImage(const std::string& file) {
  std::error_code error;
  return isExr(file) && std::filesystem::is_regular_file(file, error) && holdsSums(file);
}

void mergeParts(std::span<const std::string> parts, const OutputDescription& output, std::span<const std::string> images) {
  Merge merge;
  for (const std::string& file : parts) merge.add(file);
  merge.checkComplete();
  if (output.aovs.needDepth() && merge.sums().channels < kSumChannels)
    fail(ErrorKind::Input, "the parts have no distances, which --aov depth needs: render them with --aov depth too");
  writeImages(resolveSums(merge.sums(), valueOf(merge.header(), "freevoxels:composite") != "additive"), output, images,
              imageHeaderOf(merge, output));
}

}  // namespace freevoxels
