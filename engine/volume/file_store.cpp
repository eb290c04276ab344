#include "engine/volume/file_store.h"

#include <system_error>

#include "engine/core/random_access_file.h"
#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

class FileOfFolder : public StoredFile {
 public:
  explicit FileOfFolder(const std::filesystem::path& file) : file_(file) {}
  std::uint64_t bytes() const override { return file_.bytes(); }
  bool readAt(std::uint64_t offset, std::span<std::byte> part) const override { return file_.readAt(offset, part) == part.size(); }

 private:
  const RandomAccessFile file_;
};

class FolderStore : public FileStore {
 public:
  explicit FolderStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::unique_ptr<StoredFile> open(const std::string& name, std::uint64_t most) const override {
    const std::filesystem::path file = folder_ / name;
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) return nullptr;
    try {
      auto opened = std::make_unique<FileOfFolder>(file);
      if (opened->bytes() > most) failDamaged(file, "it is longer than what it can hold");
      return opened;
    } catch (const std::system_error& failed) {
      fail(ErrorKind::Input, "cannot read '{}': {}", file.string(), failed.code().message());
    }
  }

  std::string shown(const std::string& name) const override { return (folder_ / name).string(); }

 private:
  const std::filesystem::path folder_;
};

}  // namespace

std::unique_ptr<FileStore> openFolderStore(const std::filesystem::path& folder) {
  return std::make_unique<FolderStore>(folder);
}

std::vector<std::byte> readAll(const FileStore& store, const std::string& name, const StoredFile& file) {
  std::vector<std::byte> bytes(file.bytes());
  if (!file.readAt(0, bytes)) failDamaged(store.shown(name), "it ends too early");
  return bytes;
}

}  // namespace freevoxels
