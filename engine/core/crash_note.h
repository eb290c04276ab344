#pragma once
// What a crash of a thread would mean, for the program that reports crashes (apps/common/crash_report.h).

#include <string>
#include <utility>

namespace freevoxels {

/// Lives while the calling thread is inside a library that may crash on bad input. Another note of the same thread may live
/// inside it; notes of different threads do not know each other. Installs nothing: without a program that reads the notes a
/// crash is a crash.
class CrashNote {
 public:
  /// `sentence`: why the thread crashed, with the file and the remedy.
  explicit CrashNote(std::string sentence) : sentence_(std::move(sentence)), outer_(std::exchange(innermost, this)) {}
  ~CrashNote() { innermost = outer_; }
  CrashNote(const CrashNote&) = delete;
  CrashNote& operator=(const CrashNote&) = delete;

  /// The innermost note of the calling thread, or null. May be called by a signal handler.
  static const CrashNote* current() { return innermost; }
  const std::string& sentence() const { return sentence_; }

 private:
  inline static thread_local const CrashNote* innermost = nullptr;

  const std::string sentence_;
  const CrashNote* const outer_;
};

}  // namespace freevoxels
