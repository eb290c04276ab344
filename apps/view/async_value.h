#pragma once
// What takes too long for a frame of the window, made by a thread beside it.

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <utility>

#include "apps/view/window.h"

namespace freevoxels {

/// The value of the key that was asked for last.
template <typename Key, typename Value>
class AsyncValue {
 public:
  /// `make` is called by another thread and throws nothing.
  explicit AsyncValue(std::function<Value(const Key&)> make) : make_(std::move(make)) {}

  /// Null while it is made, one after the other; the window is woken when it is there.
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

  /// Neither key nor value is kept any longer.
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
