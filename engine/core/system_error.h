#pragma once
// Failed system calls as exceptions.

#include <cerrno>
#include <system_error>

namespace freevoxels {

/// Throws errno as std::system_error; EIO where errno is 0, as after a read that ended early.
[[noreturn]] inline void throwSystemError() {
  throw std::system_error(errno != 0 ? errno : EIO, std::generic_category());
}

}  // namespace freevoxels
