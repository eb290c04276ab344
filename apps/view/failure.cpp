#include "apps/view/failure.h"

#include <new>

namespace freevoxels {

Failure currentFailure() {
  try {
    throw;
  } catch (const Error& error) {
    return {error.code(), error.what()};
  } catch (const std::bad_alloc&) {
    return {ExitCode::OutOfMemory, "this machine's memory is full: use a smaller volume or picture"};
  } catch (const std::exception& error) {
    return {ExitCode::Internal, fmt::format("internal error, please report it: {}", error.what())};
  }
}

}  // namespace freevoxels
