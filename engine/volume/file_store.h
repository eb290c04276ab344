#pragma once
// Internal to the readers of scans: files by their names, in a folder or in a zip archive.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace freevoxels {

/// A file of a store. Any thread may read.
class StoredFile {
 public:
  virtual ~StoredFile() = default;
  virtual std::uint64_t bytes() const = 0;
  /// Fills `part` from `offset` on. Returns false where the file ends too early.
  virtual bool readAt(std::uint64_t offset, std::span<std::byte> part) const = 0;
};

class FileStore {
 public:
  virtual ~FileStore() = default;
  /// `name` has its folders separated by "/". Null where there is none of this name. Fails with ErrorKind::Input for a file that cannot be
  /// read, or takes more than `most` bytes.
  virtual std::unique_ptr<StoredFile> open(const std::string& name, std::uint64_t most) const = 0;
  /// What sentences call the file.
  virtual std::string shown(const std::string& name) const = 0;
};

std::unique_ptr<FileStore> openFolderStore(const std::filesystem::path& folder);
/// Entries that are stored or deflated, also with the sizes of Zip64. Where all entries are in one folder, names are those in it. Fails
/// with ErrorKind::Input for what is no zip archive.
std::unique_ptr<FileStore> openZipStore(const std::filesystem::path& file);

/// All of a file. Fails where it ends too early.
std::vector<std::byte> readAll(const FileStore& store, const std::string& name, const StoredFile& file);

}  // namespace freevoxels
