#pragma once
// Internal to the reader of DICOM: the elements of a file, found without GDCM, which ends the process on some damaged files.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace freevoxels {

/// (group, element) as group << 16 | element.
using DicomTag = std::uint32_t;

/// The values of elements outside of sequences, of at most 256 bytes each.
class DicomTags {
 public:
  /// Nothing for a file that does not begin as DICOM's do. Fails with ErrorKind::Input where it is cut, or its elements are damaged.
  static std::optional<DicomTags> read(const std::filesystem::path& file);

  bool has(DicomTag tag) const { return values_.contains(tag); }
  /// The text of an element, without the padding at its end; empty where there is no such element.
  std::string text(DicomTag tag) const;
  /// The value of an element of 16 bits; nothing where there is no such element.
  std::optional<std::uint16_t> number(DicomTag tag) const;
  /// Length of the values of the image in bytes; nothing without them, and where they are compressed.
  std::optional<std::uint32_t> pixelBytes() const { return pixelBytes_; }

 private:
  bool isBigEndian_ = false;
  std::map<DicomTag, std::string> values_;
  std::optional<std::uint32_t> pixelBytes_;
};

}  // namespace freevoxels
