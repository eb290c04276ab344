// DICOM part 5, sections 7 and 10, and part 10, section 7.
#include "engine/volume/dicom_tags.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "engine/core/error.h"
#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr DicomTag kSyntax = 0x00020010, kPixels = 0x7fe00010, kItem = 0xfffee000, kEndOfItem = 0xfffee00d, kEndOfItems = 0xfffee0dd;

struct Element {
  DicomTag tag = 0;
  bool hasItems = false;   ///< whether an undefined length is that of a sequence
  bool isUnknown = false;  ///< of a type that the writer did not know: its items have no types
  std::uint32_t length = 0;
};

/// How values of the data set are written.
struct Syntax {
  bool isExplicit = true, isBigEndian = false;
};

/// Reads elements one after the other, and fails where one goes on beyond the end of the file.
class ElementReader {
 public:
  explicit ElementReader(const std::filesystem::path& file)
      : file_(file), size_(std::filesystem::file_size(file)), stream_(file, std::ios::binary) {}

  bool beginsAsDicom() {
    constexpr std::uint64_t kPreamble = 128;
    if (size_ < kPreamble + 4) return false;
    skip(kPreamble);
    return read(4) == "DICM";
  }

  std::uint64_t left() const { return size_ - position_; }
  std::string read(std::uint64_t bytes) {
    require(bytes);
    std::string value(bytes, '\0');
    stream_.read(value.data(), std::streamsize(bytes));
    if (!stream_) failDamaged(file_, "it cannot be read to its end");
    position_ += bytes;
    return value;
  }
  void skip(std::uint64_t bytes) {
    require(bytes);
    position_ += bytes;
    stream_.seekg(std::streamoff(position_));
  }
  void back(std::uint64_t bytes) {
    position_ -= bytes;
    stream_.seekg(std::streamoff(position_));
  }

  Element next(Syntax syntax) {
    const std::uint32_t group = number(2, syntax), member = number(2, syntax);
    Element element{.tag = group << 16 | member};
    if (group == (kItem >> 16) || !syntax.isExplicit) {
      element.length = number(4, syntax);
      element.hasItems = true;
      return element;
    }
    const std::string type = read(2);
    constexpr std::array<std::string_view, 13> kLong{"OB", "OD", "OF", "OL", "OV", "OW", "SQ", "SV", "UC", "UN", "UR", "UT", "UV"};
    constexpr std::array<std::string_view, 21> kShort{"AE", "AS", "AT", "CS", "DA", "DS", "DT", "FD", "FL", "IS", "LO",
                                                      "LT", "PN", "SH", "SL", "SS", "ST", "TM", "UI", "UL", "US"};
    const bool isLong = std::ranges::find(kLong, type) != kLong.end();
    if (!isLong && std::ranges::find(kShort, type) == kShort.end())
      failDamaged(file_, fmt::format("element ({:04x},{:04x}) has no type", group, member));
    if (!isLong) {
      element.length = number(2, syntax);
      return element;
    }
    skip(2);
    element.length = number(4, syntax);
    element.hasItems = true;
    element.isUnknown = type == "UN";
    return element;
  }

  /// Skips the value of an element, items and all.
  void skipValue(const Element& element, Syntax syntax, int depth = 0) {
    constexpr int kDeepest = 32;
    if (element.length != kUndefined) return skip(element.length);
    if (!element.hasItems || depth > kDeepest)
      failDamaged(file_, fmt::format("element ({:04x},{:04x}) has no length", element.tag >> 16, element.tag & 0xffff));
    if (element.isUnknown) syntax = {.isExplicit = false};
    for (Element item = next(syntax); item.tag != kEndOfItems; item = next(syntax)) {
      if (item.tag != kItem) failDamaged(file_, "the items of a sequence are damaged");
      if (item.length != kUndefined) {
        skip(item.length);
        continue;
      }
      for (Element inner = next(syntax); inner.tag != kEndOfItem; inner = next(syntax)) skipValue(inner, syntax, depth + 1);
    }
  }

 private:
  void require(std::uint64_t bytes) const {
    if (bytes > left()) failDamaged(file_, fmt::format("it ends {} bytes too early", bytes - left()));
  }
  std::uint32_t number(std::uint64_t bytes, Syntax syntax) {
    const std::string raw = read(bytes);
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < raw.size(); ++i) value = value << 8 | std::uint8_t(raw[syntax.isBigEndian ? i : raw.size() - 1 - i]);
    return value;
  }

  const std::filesystem::path file_;
  const std::uint64_t size_;
  std::uint64_t position_ = 0;
  std::ifstream stream_;
};

Syntax syntaxOf(const std::filesystem::path& file, const std::string& name) {
  if (name == "1.2.840.10008.1.2") return {.isExplicit = false};
  if (name == "1.2.840.10008.1.2.2") return {.isBigEndian = true};
  if (name == "1.2.840.10008.1.2.1.99")
    fail(ErrorKind::Input, "'{}' is DICOM that is compressed as a whole, which is not read: save it with another transfer syntax",
         file.string());
  return {};
}

}  // namespace

std::optional<DicomTags> DicomTags::read(const std::filesystem::path& file) {
  constexpr std::uint32_t kLongest = 256;
  ElementReader reader(file);
  if (!reader.beginsAsDicom()) return std::nullopt;
  DicomTags tags;
  Syntax syntax;  // of the file's own elements
  bool isMeta = true;
  while (reader.left() > 0) {
    const std::uint64_t before = reader.left();
    Element element = reader.next(syntax);
    if (isMeta && element.tag >> 16 != kSyntax >> 16) {
      isMeta = false;
      syntax = syntaxOf(file, tags.text(kSyntax));
      tags.isBigEndian_ = syntax.isBigEndian;
      reader.back(before - reader.left());
      element = reader.next(syntax);
    }
    if (element.tag >> 16 == kItem >> 16) failDamaged(file, "an item is outside of its sequence");
    const bool isKept = element.length <= kLongest && element.tag != kPixels;
    std::string value;
    if (isKept)
      value = reader.read(element.length);
    else
      reader.skipValue(element, syntax);
    tags.values_[element.tag] = std::move(value);
    if (element.tag == kPixels && element.length != kUndefined) tags.pixelBytes_ = element.length;
  }
  return tags;
}

std::string DicomTags::text(DicomTag tag) const {
  const auto found = values_.find(tag);
  std::string text = found == values_.end() ? "" : found->second;
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return text;
}

std::optional<std::uint16_t> DicomTags::number(DicomTag tag) const {
  const auto found = values_.find(tag);
  if (found == values_.end() || found->second.size() != 2) return std::nullopt;
  const auto low = std::uint8_t(found->second[isBigEndian_ ? 1 : 0]), high = std::uint8_t(found->second[isBigEndian_ ? 0 : 1]);
  return std::uint16_t(high << 8 | low);
}

}  // namespace freevoxels
