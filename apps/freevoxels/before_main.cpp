// Part of every program, not of the library: what happens before main() and reportCrashes(). Debian's log4cplus, which OpenVDB is
// linked to, starts threads while the program is loaded, and an exception there would end in std::terminate.

#include <unistd.h>

#include <exception>
#include <string_view>

namespace {

[[noreturn]] void endBeforeMain() {
  constexpr std::string_view kSentence =
      "freevoxels: the program could not start: raise the limits on threads and memory (ulimit -u, ulimit -v)\n";
  constexpr int kOutOfMemory = 6;  // ErrorKind::OutOfMemory
  if (write(STDERR_FILENO, kSentence.data(), kSentence.size()) < 0) _exit(kOutOfMemory);
  _exit(kOutOfMemory);
}

void setTerminate(int, char**, char**) {
  std::set_terminate(endBeforeMain);
}

/// The loader calls it before the initialisers of all libraries.
[[gnu::section(".preinit_array"), gnu::used]] void (*const beforeLibraries)(int, char**, char**) = setTerminate;

}  // namespace
