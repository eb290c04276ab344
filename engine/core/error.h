#pragma once
// There are two kinds of error. `Error` is the user's: it carries an exit code and one sentence that names
// the file or option and the remedy. A failed FV_CHECK is a bug of ours: it prints both operands and ends the
// program with ExitCode::Internal.

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace freevoxels {

/// Exit codes of all programs, documented in apps/manual/exit_codes.md.
enum class ExitCode : int {
  Success = 0,
  Internal = 1,
  Usage = 2,
  Input = 3,
  Output = 4,
  Device = 5,
  OutOfMemory = 6,
  Comparison = 7  ///< `compare --fail-above` or a check of freevoxels-validate failed
};

class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& sentence) : std::runtime_error(sentence), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

template <typename... Args>
[[noreturn]] void fail(ExitCode code, fmt::format_string<Args...> format, Args&&... args) {
  throw Error(code, fmt::format(format, std::forward<Args>(args)...));
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
