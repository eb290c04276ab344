// Part of every program, not of the library: what happens before main() and reportCrashes(), and an exception there would end in
// std::terminate. Debian's log4cplus, which OpenVDB is linked to, starts threads while the program is loaded.

#include <unistd.h>

#include <cerrno>
#include <exception>
#include <initializer_list>
#include <new>
#include <string_view>
#include <system_error>

#include "apps/freevoxels/failure.h"
#include "engine/core/printable.h"

namespace {

using freevoxels::ExitCode;

/// Writes the parts and a line's end as they are: where memory is full, no string can be made of them.
[[noreturn]] void endWith(ExitCode code, std::initializer_list<std::string_view> parts) {
  const auto put = [&](std::string_view text) {
    if (write(STDERR_FILENO, text.data(), text.size()) < 0) _exit(int(code));
  };
  put("freevoxels: the program could not start: ");
  for (const std::string_view part : parts) put(part);
  put("\n");
  _exit(int(code));
}

[[noreturn]] void endForWantOfResources() {
  endWith(ExitCode::OutOfMemory, {"raise the limits on threads and memory (ulimit -u, ulimit -v)"});
}

[[noreturn]] void endAfterBug(std::string_view cause) {
  endWith(ExitCode::Internal, {"internal error, please report it: ", cause});
}

[[noreturn]] void endBeforeMain() {
  if (!std::current_exception()) endAfterBug("std::terminate was called");
  try {
    throw;
  } catch (const std::bad_alloc&) {
    endForWantOfResources();
  } catch (const std::system_error& error) {
    if (error.code().value() == EAGAIN || error.code().value() == ENOMEM) endForWantOfResources();
    endAfterBug(freevoxels::printable(error.what()));
  } catch (const freevoxels::Error& error) {
    endWith(freevoxels::exitCodeOf(error.kind()), {freevoxels::printable(freevoxels::withOptions(error))});
  } catch (const std::exception& error) {
    endAfterBug(freevoxels::printable(error.what()));
  } catch (...) {
    endAfterBug("an exception of unknown type");
  }
}

void setTerminate(int, char**, char**) {
  std::set_terminate(endBeforeMain);
}

/// The loader calls it before the initialisers of all libraries.
[[gnu::section(".preinit_array"), gnu::used]] void (*const beforeLibraries)(int, char**, char**) = setTerminate;

}  // namespace
