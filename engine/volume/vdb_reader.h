#pragma once
// Internal to the vdb_*.cpp files: reads OpenVDB's file format without OpenVDB.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "engine/core/error.h"

namespace freevoxels {

/// Reads little-endian values and fails at the end of the file instead of reading past it.
class VdbReader {
 public:
  /// Fails with ErrorKind::Input if the file cannot be opened.
  explicit VdbReader(const std::filesystem::path& file);

  template <typename Value>
  Value read() {
    Value value{};
    readBytes(&value, sizeof(Value));
    return value;
  }
  /// Reads the name of a grid or type; one of more than 64 KiB is an error.
  std::string readString();
  void readBytes(void* bytes, std::size_t count);
  void skip(std::uint64_t bytes);
  void seek(std::uint64_t position);
  /// Fails unless at least so many bytes follow.
  void require(std::uint64_t bytes) const {
    if (bytes > size_ - position_) failTruncated(position_ + bytes);
  }

  std::uint64_t position() const { return position_; }
  std::uint64_t size() const { return size_; }

  template <typename... Args>
  [[noreturn]] void failDamaged(fmt::format_string<Args...> format, Args&&... args) const {
    fail(ErrorKind::Input, "'{}' is damaged: {}; copy or download it again", file_.string(),
         fmt::format(format, std::forward<Args>(args)...));
  }

 private:
  [[noreturn]] void failTruncated(std::uint64_t needed) const;

  std::filesystem::path file_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;
  std::ifstream stream_;
};

/// Skips `packed` bytes that Blosc compressed from `unpacked` bytes. Fails if Blosc's header says otherwise,
/// since Blosc and OpenVDB trust that header.
void skipBlosc(VdbReader& reader, std::uint64_t packed, std::uint64_t unpacked);

}  // namespace freevoxels
