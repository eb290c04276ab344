#pragma once
// Failed system calls as exceptions.

#include <cerrno>
#include <system_error>

namespace freevoxels {

/// Throws errno, which the call that failed has set, as std::system_error; EIO where a library lost it.
[[noreturn]] inline void throwSystemError() {
  throw std::system_error(errno != 0 ? errno : EIO, std::generic_category());
}

}  // namespace freevoxels
