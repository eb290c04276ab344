#include "apps/freevoxels/failure.h"

#include <new>
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
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again)
      return {ExitCode::OutOfMemory, "no more threads can be started: end other programs, or raise the limit (ulimit -u)"};
    return {ExitCode::Internal, fmt::format("internal error, please report it: {}", error.what())};
  } catch (const std::exception& error) {
    return {ExitCode::Internal, fmt::format("internal error, please report it: {}", error.what())};
  } catch (...) {
    return {ExitCode::Internal, "internal error, please report it: an exception of unknown type"};
  }
}

}  // namespace freevoxels
