#include "engine/core/random_access_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <system_error>

#include "engine/core/system_error.h"

namespace freevoxels {

std::size_t readAt(int descriptor, std::uint64_t offset, std::span<std::byte> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = pread(descriptor, bytes.data() + done, bytes.size() - done, off_t(offset + done));
    if (count == 0) break;
    if (count > 0)
      done += std::size_t(count);
    else if (errno != EINTR)
      throwSystemError();
  }
  return done;
}

// Opening a pipe without O_NONBLOCK would wait for somebody to write to it.
RandomAccessFile::RandomAccessFile(const std::filesystem::path& file)
    : descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (descriptor_ < 0) throwSystemError();
  int error = fstat(descriptor_, &opened_) != 0 ? errno : S_ISDIR(opened_.st_mode) ? EISDIR : S_ISREG(opened_.st_mode) ? 0 : EINVAL;
  if (error != 0) {
    close(descriptor_);
    throw std::system_error(error, std::generic_category());
  }
  // The kernel's own guesses of what will be read next are of megabytes.
  posix_fadvise(descriptor_, 0, 0, POSIX_FADV_RANDOM);
}

RandomAccessFile::~RandomAccessFile() {
  close(descriptor_);
}

bool RandomAccessFile::hasChanged() const {
  struct stat now {};
  if (fstat(descriptor_, &now) != 0) return true;
  return now.st_size != opened_.st_size || now.st_mtim.tv_sec != opened_.st_mtim.tv_sec || now.st_mtim.tv_nsec != opened_.st_mtim.tv_nsec;
}

}  // namespace freevoxels
