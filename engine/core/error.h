#pragma once
// There are two kinds of error. `Error` is the user's: it carries a category and one sentence that names the
// file or parameter and the remedy. A failed FV_CHECK is a bug of ours: an InternalError that prints both operands.

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/parameter.h"

namespace freevoxels {

enum class ErrorKind {
  Internal,     ///< a bug
  Usage,        ///< a parameter does not exist, contradicts others, or has an impossible value
  Input,        ///< a file or value that was read cannot be used
  Output,       ///< a file cannot be written
  Device,       ///< there is no such Vulkan device, or it failed
  OutOfMemory,  ///< of the device or the host
  Comparison    ///< a comparison or check found a larger difference than allowed
};

class Error : public std::runtime_error {
 public:
  /// `text` is the sentence, in which parameters may be marked (parameter.h). what() has their bare names.
  Error(ErrorKind kind, const std::string& text) : std::runtime_error(plainlySpelled(text)), kind_(kind), text_(text) {}
  ErrorKind kind() const { return kind_; }
  /// The names of the parameters in the sentence: the user may change them, or gave them wrongly.
  std::vector<std::string> parameters() const { return parametersIn(text_); }
  /// The sentence with its parameters marked, for spelled().
  const std::string& text() const { return text_; }

 private:
  ErrorKind kind_;
  std::string text_;
};

template <typename... Args>
[[noreturn]] void fail(ErrorKind kind, fmt::format_string<Args...> format, Args&&... args) {
  throw Error(kind, fmt::format(format, std::forward<Args>(args)...));
}

class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] inline void checkFailed(const char* expression, const std::string& values, const char* file,
                                     int line) {
  throw InternalError(fmt::format("{}:{}: check failed: {} ({})", file, line, expression, values));
}

}  // namespace freevoxels

#define FV_CHECK_OP(a, op, b)                                                                              \
  do {                                                                                                     \
    const auto& fvA = (a);                                                                                 \
    const auto& fvB = (b);                                                                                 \
    if (!(fvA op fvB))                                                                                     \
      ::freevoxels::checkFailed(#a " " #op " " #b, fmt::format("{} vs {}", fvA, fvB), __FILE__, __LINE__); \
  } while (false)

#define FV_CHECK_EQ(a, b) FV_CHECK_OP(a, ==, b)
#define FV_CHECK_LE(a, b) FV_CHECK_OP(a, <=, b)
#define FV_CHECK_LT(a, b) FV_CHECK_OP(a, <, b)
