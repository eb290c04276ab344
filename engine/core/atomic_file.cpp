#include "engine/core/atomic_file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <system_error>

#include "engine/core/checked_file.h"
#include "engine/core/error.h"
#include "engine/core/system_error.h"

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

/// Symbolic links are followed at most so often, as Linux does.
constexpr int kMaxLinks = 40;

/// The file that a symbolic link points to, whether or not it exists: writing replaces that file and keeps the link.
fs::path followLinks(fs::path file) {
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(file, error); ++i) {
    const fs::path target = fs::read_symlink(file, error);
    if (error) break;
    file = folderOf(file) / target;  // an absolute target takes the place of the folder
  }
  return file;
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
    case EFBIG:
      return "raise the limit on the size of files (ulimit -f)";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return "choose another folder";
  }
}

[[noreturn]] void failBecause(const fs::path& destination, int error) {
  fail(ErrorKind::Output, "cannot write '{}': {}; {}", destination.string(),
       asClause(std::generic_category().message(error)), remedyFor(error));
}

/// Fails for an exception without an error number: the free space tells whether the disk is full.
[[noreturn]] void failBecause(const fs::path& destination, const std::string& message) {
  std::error_code error;
  const fs::space_info space = fs::space(folderOf(destination), error);
  if (!error && space.available < kNoSpaceLeft) failBecause(destination, ENOSPC);
  fail(ErrorKind::Output, "cannot write '{}': {}; {}", destination.string(), asClause(message), remedyFor(0));
}

/// A name beside `target` that no other process and no other thread uses.
fs::path unusedName(const fs::path& target) {
  std::random_device random;
  return folderOf(target) / fmt::format(".freevoxels-{:08x}{:08x}.tmp", random(), random());
}

/// Flushes to the disk. Some file systems cannot flush a folder: nothing can be done about that.
void flushToDisk(int descriptor) {
  if (fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP) throwSystemError();
}

/// The new contents of a file, in its folder, until `publish` gives them its name. They have no name before that where the
/// file system allows it (Linux's O_TMPFILE), so that a killed process leaves nothing behind; else a hidden, random one.
/// Every member throws std::system_error.
class PendingFile {
 public:
  explicit PendingFile(const fs::path& target) : target_(target) {
    descriptor_ = open(folderOf(target).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    path_ = fmt::format("/proc/self/fd/{}", descriptor_);
    if (descriptor_ >= 0 && access(path_.c_str(), W_OK) == 0) return;
    if (descriptor_ >= 0) close(descriptor_);
    path_ = unusedName(target);
    descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throwSystemError();
    isNamed_ = true;
  }
  ~PendingFile() {
    if (isNamed_) unlink(path_.c_str());
    close(descriptor_);
  }
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Opening it opens the pending file.
  const fs::path& path() const { return path_; }

  /// Whether the file has all the bytes that a process may write into one.
  bool isAtLimit() const {
    rlimit limit{};
    struct stat status {};
    return getrlimit(RLIMIT_FSIZE, &limit) == 0 && fstat(descriptor_, &status) == 0 && rlim_t(status.st_size) >= limit.rlim_cur;
  }

  void publish() {
    takeModeOfTarget();
    flushToDisk(descriptor_);
    if (!isNamed_ && !linkAs(target_)) {
      // A link cannot replace a file; renaming can. Being killed between the two calls would leave the hidden name.
      const fs::path name = unusedName(target_);
      if (!linkAs(name)) throwSystemError();
      path_ = name;
      isNamed_ = true;
    }
    if (isNamed_ && std::rename(path_.c_str(), target_.c_str()) != 0) throwSystemError();
    isNamed_ = false;
    flushFolder();
  }

 private:
  /// Also its owner and group, where this process may set them.
  void takeModeOfTarget() const {
    struct stat status {};
    if (fstat(descriptor_, &status) != 0) throwSystemError();
    if (status.st_size == 0) throw std::runtime_error("nothing was written");
    if (stat(target_.c_str(), &status) != 0) return;
    if (fchown(descriptor_, status.st_uid, status.st_gid) != 0 && errno != EPERM) throwSystemError();
    if (fchmod(descriptor_, status.st_mode & 07777) != 0 && errno != EPERM) throwSystemError();
  }

  /// False where a file of that name exists.
  bool linkAs(const fs::path& name) const {
    if (linkat(AT_FDCWD, path_.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) return true;
    if (errno != EEXIST) throwSystemError();
    return false;
  }

  void flushFolder() const {
    const int folder = open(folderOf(target_).c_str(), O_RDONLY | O_CLOEXEC);
    if (folder < 0) return;  // one that may be written to but not read
    fsync(folder);
    close(folder);
  }

  const fs::path target_;
  fs::path path_;
  int descriptor_ = -1;
  bool isNamed_ = false;
};

/// Turns the exceptions of `action` into sentences about `destination`.
void reportAbout(const fs::path& destination, const std::function<void()>& action) {
  try {
    action();
  } catch (const Error&) {
    throw;
  } catch (const InternalError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::system_error& e) {
    const bool hasErrno = e.code().category() == std::generic_category() || e.code().category() == std::system_category();
    if (hasErrno) failBecause(destination, e.code().value());
    failBecause(destination, e.what());
  } catch (const std::exception& e) {
    failBecause(destination, e.what());
  }
}

}  // namespace

void writeAtomically(const std::filesystem::path& destination,
                     const std::function<void(const std::filesystem::path&)>& write) {
  std::optional<PendingFile> pending;
  reportAbout(destination, [&] { pending.emplace(followLinks(destination)); });
  // While a sentence is made of a failure, the file is still there: it is what fills the disk.
  reportAbout(destination, [&] {
    try {
      write(pending->path());
    } catch (const std::exception&) {  // not every library says that this was the reason
      if (pending->isAtLimit()) throw std::system_error(EFBIG, std::generic_category());
      throw;
    }
    pending->publish();
  });
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
    fail(ErrorKind::Output, "cannot write '{}': it names no file; add a file name", destination.string());
  const fs::path target = followLinks(destination);
  const fs::path folder = folderOf(target);
  std::error_code error;
  const fs::file_status folderStatus = fs::status(folder, error);
  if (folderStatus.type() == fs::file_type::none) failBecause(destination, error.value());
  if (!fs::is_directory(folderStatus))
    fail(ErrorKind::Output, "cannot write '{}': there is no folder '{}'; create it or choose another folder",
         destination.string(), folder.string());
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status))
    fail(ErrorKind::Output, "cannot write '{}': it is a folder; add a file name", destination.string());
  if (fs::exists(status) && !fs::is_regular_file(status))
    fail(ErrorKind::Output, "cannot write '{}': it is not a regular file; choose another name",
         destination.string());
  if (fs::exists(status) && access(target.c_str(), W_OK) != 0) failBecause(destination, errno);
  if (status.type() == fs::file_type::none) failBecause(destination, error.value());

  // Permissions do not tell everything (read-only and virtual file systems): only creating a file does.
  reportAbout(destination, [&] { const PendingFile probe(target); });
}

}  // namespace freevoxels
