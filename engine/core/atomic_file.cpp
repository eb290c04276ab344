#include "engine/core/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <new>
#include <string>
#include <system_error>

#include "engine/core/checked_file.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

/// If a library does not say why a write failed, and fewer bytes than this are free, the disk is taken to be
/// full.
constexpr std::uintmax_t kNoSpaceLeft = 4096;

/// The folder of `file`, or "." if its name has none.
fs::path folderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// At most the first `bytes` bytes of `text`, without an incomplete UTF-8 character at the end.
std::string cutUtf8(const std::string& text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u; };
  while (bytes > 0 && continues(text[bytes])) --bytes;
  return text.substr(0, bytes);
}

/// Returns a new name ".NAME.PID.NUMBER.tmp.EXT" in the folder of `target` at each call, so that threads that
/// write files with similar names do not collide. NAME is cut so that the temporary name is not too long
/// where the target's is not.
fs::path temporaryPath(const fs::path& target) {
  constexpr std::size_t kLongestStem = 100;
  static std::atomic<unsigned> number = 0;
  const std::string stem = cutUtf8(target.stem().string(), kLongestStem);
  return folderOf(target) /
         fmt::format(".{}.{}.{}.tmp{}", stem, getpid(), number++, target.extension().string());
}

/// Returns the path that the rename has to replace: the file that a symbolic link points to, not the link.
fs::path followLink(const fs::path& destination) {
  std::error_code error;
  if (!fs::is_symlink(destination, error)) return destination;
  fs::path target = fs::canonical(destination, error);
  return error ? destination : target;
}

/// A library's message in a form that fits into a sentence: one line without a full stop.
std::string asClause(std::string message) {
  std::replace_if(
      message.begin(), message.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  while (!message.empty() && (message.back() == ' ' || message.back() == '.')) message.pop_back();
  return message.empty() ? "the reason is unknown" : message;
}

const char* remedyFor(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "free some space there or choose another folder";
    case EACCES:
    case EPERM:
    case EROFS:
      return "change its permissions or choose another folder";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return "choose another folder";
  }
}

[[noreturn]] void failBecause(const fs::path& destination, int error) {
  fail(ExitCode::Output, "cannot write '{}': {}; {}", destination.string(),
       asClause(std::generic_category().message(error)), remedyFor(error));
}

/// Fails for an exception without an error number: the free space tells whether the disk is full.
[[noreturn]] void failBecause(const fs::path& destination, const std::string& message) {
  std::error_code error;
  const fs::space_info space = fs::space(folderOf(destination), error);
  if (!error && space.available < kNoSpaceLeft) failBecause(destination, ENOSPC);
  fail(ExitCode::Output, "cannot write '{}': {}; {}", destination.string(), asClause(message), remedyFor(0));
}

/// Removes the file when it goes out of scope, unless `file` is null then.
struct RemoveOnExit {
  const fs::path* file;
  ~RemoveOnExit() {
    if (file != nullptr) unlink(file->c_str());
  }
};

/// Opens, flushes to the disk and closes. Returns 0 or the error number.
int flushToDisk(const fs::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  int error = fsync(descriptor) == 0 ? 0 : errno;
  // Some file systems cannot flush a folder; there is nothing to do about that.
  if (error == EINVAL || error == ENOTSUP) error = 0;
  if (close(descriptor) != 0 && error == 0) error = errno;
  return error;
}

void callWriter(const fs::path& destination, const fs::path& temporary,
                const std::function<void(const fs::path&)>& write) {
  try {
    write(temporary);
  } catch (const Error&) {
    throw;
  } catch (const InternalError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::system_error& e) {
    failBecause(destination, e.code().value());
  } catch (const std::exception& e) {
    failBecause(destination, e.what());
  }
}

}  // namespace

void writeAtomically(const std::filesystem::path& destination,
                     const std::function<void(const std::filesystem::path&)>& write) {
  const fs::path target = followLink(destination);
  const fs::path temporary = temporaryPath(target);
  RemoveOnExit remove{&temporary};
  callWriter(destination, temporary, write);
  if (const int error = flushToDisk(temporary)) failBecause(destination, error);
  if (std::rename(temporary.c_str(), target.c_str()) != 0) failBecause(destination, errno);
  remove.file = nullptr;
  flushToDisk(folderOf(target));
}

void writeTextAtomically(const std::filesystem::path& destination, std::string_view text) {
  writeAtomically(destination, [&](const std::filesystem::path& temporary) {
    CheckedFile output(temporary);
    output.write(text.data(), text.size());
    output.close();
  });
}

void checkWritable(const std::filesystem::path& destination) {
  if (!destination.has_filename())
    fail(ExitCode::Output, "cannot write '{}': it names no file; add a file name", destination.string());
  const fs::path target = followLink(destination);
  const fs::path folder = folderOf(target);
  std::error_code error;
  if (!fs::is_directory(folder, error))
    fail(ExitCode::Output, "cannot write '{}': there is no folder '{}'; create it or choose another folder",
         destination.string(), folder.string());
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status))
    fail(ExitCode::Output, "cannot write '{}': it is a folder; add a file name", destination.string());
  if (fs::exists(status) && !fs::is_regular_file(status))
    fail(ExitCode::Output, "cannot write '{}': it is not a regular file; choose another name",
         destination.string());
  if (fs::exists(status) && access(target.c_str(), W_OK) != 0) failBecause(destination, errno);
  if (status.type() == fs::file_type::none) failBecause(destination, error.value());

  // Permissions do not tell everything (read-only and virtual file systems): only creating a file does.
  const fs::path temporary = temporaryPath(target);
  const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) failBecause(destination, errno);
  close(descriptor);
  unlink(temporary.c_str());
}

}  // namespace freevoxels
