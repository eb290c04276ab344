#pragma once
// A file that is read at any place, into the caller's memory: other than a map of it, the memory stays whatever happens to the file.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include <sys/stat.h>

namespace freevoxels {

/// Reads from `offset` until `bytes` is full or the file ends, whatever signals arrive meanwhile. Returns how many bytes were read. Throws
/// std::system_error.
std::size_t readAt(int descriptor, std::uint64_t offset, std::span<std::byte> bytes);

/// Several threads may read at the same time.
class RandomAccessFile {
 public:
  /// Throws std::system_error, also for what is no regular file.
  explicit RandomAccessFile(const std::filesystem::path& file);
  ~RandomAccessFile();
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;

  /// The size of the file when it was opened.
  std::uint64_t bytes() const { return std::uint64_t(opened_.st_size); }
  /// Returns how many bytes were read: fewer than wanted where the file ends. Throws std::system_error.
  std::size_t readAt(std::uint64_t offset, std::span<std::byte> bytes) const { return freevoxels::readAt(descriptor_, offset, bytes); }
  /// Whether the file was written to or cut since it was opened. A file that took its name does not count: the opened one is still there.
  bool hasChanged() const;

 private:
  int descriptor_;
  struct stat opened_ {};
};

}  // namespace freevoxels
