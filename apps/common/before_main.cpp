// Part of every program, not of the library: what happens before main() and reportCrashes(), and an exception there would end in
// std::terminate. Debian's log4cplus, which OpenVDB is linked to, starts threads while the program is loaded.

#include <unistd.h>

#include <cerrno>
#include <exception>
#include <new>
#include <string_view>
#include <system_error>

#include "apps/common/failure.h"
#include "engine/core/printable.h"

namespace {

using freevoxels::ExitCode;

/// Writes the sentence as it is: where memory is full, no longer string can be made of it.
[[noreturn]] void endWith(ExitCode code, std::string_view sentence) {
  for (const std::string_view part : {std::string_view("freevoxels: the program could not start: "), sentence, std::string_view("\n")})
    if (write(STDERR_FILENO, part.data(), part.size()) < 0) break;
  _exit(int(code));
}

/// Whether the exception that is being handled is the want of memory or threads.
bool isWantOfResources() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return true;
  } catch (const std::system_error& error) {
    return error.code().value() == EAGAIN || error.code().value() == ENOMEM;
  } catch (...) {
    return false;
  }
}

[[noreturn]] void endBeforeMain() {
  if (!std::current_exception()) endWith(ExitCode::Internal, "internal error, please report it: std::terminate was called");
  try {
    throw;
  } catch (...) {
    if (isWantOfResources()) endWith(ExitCode::OutOfMemory, "raise the limits on threads and memory (ulimit -u, ulimit -v)");
    const freevoxels::Failure failure = freevoxels::currentFailure();
    endWith(failure.code, freevoxels::printable(failure.sentence));
  }
}

void setTerminate(int, char**, char**) {
  std::set_terminate(endBeforeMain);
}

/// The loader calls it before the initialisers of all libraries.
[[gnu::section(".preinit_array"), gnu::used]] void (*const beforeLibraries)(int, char**, char**) = setTerminate;

}  // namespace
