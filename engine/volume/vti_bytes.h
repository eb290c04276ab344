#pragma once
// Internal to the reader of .vti: the bytes of values, which are in the file as they are, in text, or in base64.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/random_access_file.h"

namespace freevoxels {

/// Where bytes of the file come from, one after the other.
class ByteStream {
 public:
  virtual ~ByteStream() = default;
  /// Fills all of `bytes`; false where there are not so many.
  virtual bool read(std::span<std::byte> bytes) = 0;
  /// Begins a part that was encoded for itself.
  virtual void beginPart() {}
};

class FileBytes : public ByteStream {
 public:
  FileBytes(const RandomAccessFile& file, std::uint64_t offset) : file_(file), at_(offset) {}
  bool read(std::span<std::byte> bytes) override {
    const std::size_t kept = std::min(bytes.size(), kept_.size());
    std::ranges::copy(kept_.first(kept), bytes.begin());
    kept_ = kept_.subspan(kept);
    bytes = bytes.subspan(kept);
    if (bytes.size() >= kAhead) return take(bytes) == bytes.size();
    if (bytes.empty()) return true;
    ahead_.resize(kAhead);
    kept_ = std::span(ahead_).first(take(ahead_));
    return !kept_.empty() && read(bytes);
  }

 private:
  static constexpr std::size_t kAhead = std::size_t(1) << 16;

  std::size_t take(std::span<std::byte> bytes) {
    const std::size_t count = file_.readAt(at_, bytes);
    at_ += count;
    return count;
  }

  const RandomAccessFile& file_;
  std::uint64_t at_;
  std::vector<std::byte> ahead_;                ///< read ahead
  std::span<std::byte> kept_;  ///< of them, what was not yet asked for
};

class TextBytes : public ByteStream {
 public:
  explicit TextBytes(std::string_view text) : text_(text) {}
  bool read(std::span<std::byte> bytes) override {
    while (!text_.empty() && std::strchr(" \n\r\t", text_.front())) text_.remove_prefix(1);
    if (bytes.size() > text_.size()) return false;
    std::memcpy(bytes.data(), text_.data(), bytes.size());
    text_.remove_prefix(bytes.size());
    return true;
  }

 private:
  std::string_view text_;
};

/// The bytes of base64, of which every part ends with a group of four characters of its own.
class Base64Bytes : public ByteStream {
 public:
  explicit Base64Bytes(std::unique_ptr<ByteStream> text) : text_(std::move(text)) {}
  bool read(std::span<std::byte> bytes) override {
    for (std::byte& byte : bytes) {
      if (next_ == kGroup && !decodeMore()) return false;
      byte = group_[next_++];
    }
    return true;
  }
  void beginPart() override { next_ = kGroup; }

 private:
  static constexpr std::size_t kGroup = 3;

  static int valueOf(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : c == '=' ? 0 : -1;
  }

  bool decodeMore() {
    char text[4];
    if (!text_->read(std::as_writable_bytes(std::span(text)))) return false;
    std::uint32_t bits = 0;
    for (const char c : text) {
      const int value = valueOf(c);
      if (value < 0) return false;
      bits = bits << 6 | std::uint32_t(value);
    }
    for (std::size_t i = 0; i < kGroup; ++i) group_[i] = std::byte(bits >> (16 - 8 * i));
    next_ = 0;
    return true;
  }

  const std::unique_ptr<ByteStream> text_;
  std::array<std::byte, kGroup> group_{};
  std::size_t next_ = kGroup;
};

}  // namespace freevoxels
