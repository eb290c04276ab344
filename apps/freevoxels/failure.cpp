#include "apps/freevoxels/failure.h"

#include <cerrno>
#include <new>
#include <string_view>
#include <system_error>

namespace freevoxels {

Failure currentFailure() {
  try {
    throw;
  } catch (const Error& error) {
    return {error.code(), error.what()};
  } catch (const std::bad_alloc&) {
    return {ExitCode::OutOfMemory,
            "this machine's memory, or the share that this process may use (ulimit -v), is full: use a smaller volume or image"};
  } catch (const std::exception& error) {
    // std::thread and oneTBB have different exceptions for it.
    if (std::string_view(error.what()).find(std::generic_category().message(EAGAIN)) != std::string_view::npos)
      return {ExitCode::OutOfMemory, "no more threads can be started: raise the limits on threads and memory (ulimit -u, ulimit -v), or end other programs"};
    return {ExitCode::Internal, fmt::format("internal error, please report it: {}", error.what())};
  } catch (...) {
    return {ExitCode::Internal, "internal error, please report it: an exception of unknown type"};
  }
}

}  // namespace freevoxels
