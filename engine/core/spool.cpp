#include "engine/core/spool.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

namespace freevoxels {

namespace {

[[noreturn]] void throwErrno() {
  throw std::system_error(errno != 0 ? errno : EIO, std::generic_category());
}

}  // namespace

Spool::Spool(const std::filesystem::path& folder) {
  std::string name = (folder / ".freevoxels-spool.XXXXXX").string();
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) throwErrno();
  unlink(name.c_str());
  file_ = fdopen(descriptor, "w+b");
  if (file_ == nullptr) {
    close(descriptor);
    throwErrno();
  }
}

void Spool::append(std::span<const std::byte> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) throwErrno();
  bytes_ += bytes.size();
}

void Spool::flush() {
  if (std::fflush(file_) != 0) throwErrno();
}

void Spool::readAt(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = pread(fileno(file_), bytes.data(), bytes.size(), off_t(offset));
    if (count <= 0) throwErrno();
    offset += std::uint64_t(count);
    bytes = bytes.subspan(std::size_t(count));
  }
}

}  // namespace freevoxels
