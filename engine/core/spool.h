#pragma once
// An unnamed temporary file for data whose place in a file is known only later. It disappears when it is closed or the program ends.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <vector>

namespace freevoxels {

/// All functions throw std::system_error if the disk fails.
class Spool {
 public:
  explicit Spool(const std::filesystem::path& folder);
  ~Spool() { std::fclose(file_); }
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  std::uint64_t bytes() const { return bytes_; }
  void append(std::span<const std::byte> bytes);
  /// Makes what was appended readable by readAt.
  void flush();
  /// Several threads may read at the same time.
  void readAt(std::uint64_t offset, std::span<std::byte> bytes) const;
  /// Reads the whole file, a piece at a time.
  template <typename Function>
  void readAll(const Function& take) {
    flush();
    std::vector<std::byte> piece(std::size_t(1) << 20);
    for (std::uint64_t first = 0; first < bytes_; first += piece.size()) {
      const std::span<std::byte> part = std::span(piece).first(std::min<std::uint64_t>(piece.size(), bytes_ - first));
      readAt(first, part);
      take(std::span<const std::byte>(part));
    }
  }

 private:
  std::FILE* file_ = nullptr;
  std::uint64_t bytes_ = 0;
};

}  // namespace freevoxels
