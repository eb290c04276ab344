#pragma once
// A value that is computed by another thread, because it takes too long for a frame of the window.

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <utility>

#include "apps/view/window.h"

namespace freevoxels {

/// Computes the value of the key that was requested last.
template <typename Key, typename Value>
class AsyncValue {
 public:
  /// `make` is called by another thread and must not throw.
  explicit AsyncValue(std::function<Value(const Key&)> make) : make_(std::move(make)) {}

  /// The value of `key`, or null while it is computed. One value is computed at a time; the window is woken
  /// when it is ready.
  const Value* of(const Key& key) {
    if (!made_.valid() && key_ != key) {
      key_ = key;
      value_.reset();
      made_ = std::async(std::launch::async, [make = make_, key] {
        Value value = make(key);
        Window::wake();
        return value;
      });
    }
    if (made_.valid() && made_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
      value_ = made_.get();
    return value_ && key_ == key ? &*value_ : nullptr;
  }

  bool isMaking() const { return made_.valid(); }

  /// Forgets key and value.
  void forget() {
    key_.reset();
    value_.reset();
  }

 private:
  const std::function<Value(const Key&)> make_;
  std::optional<Key> key_;
  std::optional<Value> value_;
  std::future<Value> made_;
};

}  // namespace freevoxels
