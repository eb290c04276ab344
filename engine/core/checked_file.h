#pragma once
// A binary file for writing that reports every failure. Libraries that write through C or C++ streams lose
// the error of the last buffered bytes when the disk is full.

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace freevoxels {

/// Every member throws std::system_error with the reason. A file that was not closed by `close` is not
/// complete.
class CheckedFile {
 public:
  explicit CheckedFile(const std::filesystem::path& file) : file_(std::fopen(file.c_str(), "wb")) {
    if (!file_) throwErrno();
  }
  ~CheckedFile() {
    if (file_) std::fclose(file_);
  }
  CheckedFile(const CheckedFile&) = delete;
  CheckedFile& operator=(const CheckedFile&) = delete;

  void write(const void* bytes, std::size_t count) {
    if (count > 0 && std::fwrite(bytes, 1, count, file_) != count) throwErrno();  // fwrite accepts no null pointer
  }
  std::uint64_t tell() const {
    const off_t position = ftello(file_);
    if (position < 0) throwErrno();
    return std::uint64_t(position);
  }
  void seek(std::uint64_t position) {
    if (fseeko(file_, off_t(position), SEEK_SET) != 0) throwErrno();
  }
  /// Also throws if any earlier write failed, even if a library in between swallowed its exception.
  void close() {
    const bool failedEarlier = std::ferror(file_) != 0;
    const bool failedNow = std::fclose(std::exchange(file_, nullptr)) != 0;
    if (failedNow) throwErrno();
    if (failedEarlier) throw std::system_error(firstError_ ? firstError_ : EIO, std::generic_category());
  }

 private:
  [[noreturn]] void throwErrno() const {
    if (!firstError_) firstError_ = errno ? errno : EIO;
    throw std::system_error(firstError_, std::generic_category());
  }

  std::FILE* file_;
  mutable int firstError_ = 0;
};

}  // namespace freevoxels
