#pragma once
// Values as bytes that one process sends to another of the same build.

#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "engine/core/error.h"

namespace freevoxels::fvx {

class BytePacker {
 public:
  template <typename Value>
  void value(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    append(std::as_bytes(std::span(&value, 1)));
  }
  /// The number of values, then the values.
  template <typename Value>
  void values(const std::vector<Value>& values) {
    value(values.size());
    append(std::as_bytes(std::span(values)));
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void append(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

  std::vector<std::byte> bytes_;
};

/// Reads what a BytePacker wrote, in the same order.
class ByteUnpacker {
 public:
  explicit ByteUnpacker(std::span<const std::byte> bytes) : rest_(bytes) {}

  bool atEnd() const { return rest_.empty(); }
  template <typename Value>
  void value(Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    copy(std::as_writable_bytes(std::span(&value, 1)));
  }
  template <typename Value>
  void values(std::vector<Value>& values) {
    std::size_t count = 0;
    value(count);
    values.resize(count);
    copy(std::as_writable_bytes(std::span(values)));
  }

 private:
  void copy(std::span<std::byte> to) {
    FV_CHECK_LE(to.size(), rest_.size());
    if (!to.empty()) std::memcpy(to.data(), rest_.data(), to.size());
    rest_ = rest_.subspan(to.size());
  }

  std::span<const std::byte> rest_;
};

}  // namespace freevoxels::fvx
