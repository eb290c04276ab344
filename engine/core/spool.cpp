#include "engine/core/spool.h"

#include <unistd.h>

#include <cstdlib>
#include <string>

#include "engine/core/random_access_file.h"
#include "engine/core/system_error.h"

namespace freevoxels {

Spool::Spool(const std::filesystem::path& folder) {
  std::string name = (folder / ".freevoxels-spool.XXXXXX").string();
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) throwSystemError();
  unlink(name.c_str());
  file_ = fdopen(descriptor, "w+b");
  if (file_ == nullptr) {
    close(descriptor);
    throwSystemError();
  }
}

void Spool::append(std::span<const std::byte> bytes) {
  if (bytes.empty()) return;  // An empty span may have a null pointer, which fwrite does not accept.
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) throwSystemError();
  bytes_ += bytes.size();
}

void Spool::flush() {
  if (std::fflush(file_) != 0) throwSystemError();
}

void Spool::readAt(std::uint64_t offset, std::span<std::byte> bytes) const {
  if (freevoxels::readAt(fileno(file_), offset, bytes) == bytes.size()) return;
  throw std::system_error(EIO, std::generic_category());  // it is shorter than what was written to it
}

}  // namespace freevoxels
