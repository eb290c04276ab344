#include "apps/common/crash_report.h"

#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <string_view>

#include "apps/common/failure.h"
#include "engine/core/crash_note.h"
#include "engine/core/printable.h"

namespace freevoxels {

namespace {

// A signal handler may not allocate: it writes text that exists before.
std::string prefix, sentenceWithoutNote;
ExitCode codeWithoutNote = ExitCode::Internal;

void writeAll(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(std::size_t(written));
  }
}

[[noreturn]] void endWith(std::string_view sentence, ExitCode code) {
  writeAll(prefix);
  writeAll(sentence);
  writeAll("\n");
  _exit(int(code));
}

extern "C" void endAfterCrash(int) {
  if (const CrashNote* note = CrashNote::current()) endWith(note->sentence(), ExitCode::Input);
  endWith(sentenceWithoutNote, codeWithoutNote);
}

[[noreturn]] void endAfterTerminate() {
  if (!std::current_exception()) endWith(sentenceWithoutNote, codeWithoutNote);
  try {
    throw;
  } catch (...) {
    const Failure failure = currentFailure();
    endWith(printable(failure.sentence), failure.code);
  }
}

void describeCrashesWithoutNote() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    sentenceWithoutNote = fmt::format(
        "the program stopped, most likely for want of memory: it may use {} MiB (ulimit -v); raise that limit, or use a smaller "
        "volume or image",
        limit.rlim_cur >> 20);
    codeWithoutNote = ExitCode::OutOfMemory;
  } else if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    sentenceWithoutNote = fmt::format(
        "the program stopped, most likely as its files may have {} KiB (ulimit -f): drivers for the CPU have their memory in files, too; "
        "raise "
        "that limit",
        limit.rlim_cur >> 10);
    codeWithoutNote = ExitCode::Output;
  } else {
    sentenceWithoutNote = "internal error, please report it with the command and its files: the program crashed";
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
void handleCrashes() {
  static std::array<char, 1 << 16> stack;  // the thread's own may have overflowed
  const stack_t alternative{.ss_sp = stack.data(), .ss_flags = 0, .ss_size = stack.size()};
  sigaltstack(&alternative, nullptr);
  struct sigaction action {};
  action.sa_handler = endAfterCrash;
  action.sa_flags = SA_ONSTACK;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) sigaction(signal, &action, nullptr);
}
#else
void handleCrashes() {}
#endif

}  // namespace

void reportCrashes(const std::string& program) {
  prefix = program + ": ";
  describeCrashesWithoutNote();
  handleCrashes();
  std::set_terminate(endAfterTerminate);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace freevoxels
