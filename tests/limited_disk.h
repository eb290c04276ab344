#pragma once
// A disk that is full after a few kilobytes, for tests of "disk full": a tmpfs in a mount namespace of its
// own.

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "engine/core/error.h"

namespace freevoxels::test {

/// Mounts a tmpfs of `bytes` over `folder`, for this process alone. False where the system does not allow it.
inline bool mountLimitedDisk(const std::filesystem::path& folder, std::size_t bytes) {
  if (unshare(CLONE_NEWNS) != 0) {
    // Without the right to mount: in a user namespace where this user is root.
    const std::string user = "0 " + std::to_string(geteuid()) + " 1",
                      group = "0 " + std::to_string(getegid()) + " 1";
    if (unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    std::ofstream("/proc/self/setgroups") << "deny";
    std::ofstream("/proc/self/uid_map") << user;
    std::ofstream("/proc/self/gid_map") << group;
  }
  if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return false;
  const std::string options = "size=" + std::to_string(bytes);
  if (mount("tmpfs", folder.c_str(), "tmpfs", 0, options.c_str()) != 0) return false;
  return access(folder.c_str(), W_OK) == 0;
}

inline bool canLimitDisks(const std::filesystem::path& folder) {
  const pid_t child = fork();
  if (child == 0) _exit(mountLimitedDisk(folder, 65536) ? 0 : 1);
  int status = 0;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// For EXPECT_EXIT: calls `action(folder)` with a limited disk mounted on the folder, prints the error's
/// sentence and exits with the number of its kind. Exits with 99 if anything is left on the disk, with 98 if there is no
/// such disk.
template <typename Action>
[[noreturn]] void exitWithErrorOnLimitedDisk(const std::filesystem::path& folder, std::size_t bytes,
                                             Action&& action) {
  int code = 0;
  if (!mountLimitedDisk(folder, bytes)) _exit(98);
  try {
    action(folder);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    code = int(error.kind());
  }
  for (const auto& left : std::filesystem::directory_iterator(folder)) {
    std::fprintf(stderr, "left behind: %s\n", left.path().c_str());
    code = 99;
  }
  umount(folder.c_str());
  std::filesystem::remove_all(folder);  // a death test runs in a process and a temporary folder of its own
  _exit(code);
}

}  // namespace freevoxels::test

/// Skips the test, saying so, where no file system can be mounted.
#define FV_REQUIRE_LIMITED_DISK(folder)           \
  if (!::freevoxels::test::canLimitDisks(folder)) \
  GTEST_SKIP() << "this system lets the test mount no limited file system"
