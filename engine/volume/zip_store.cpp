// Zip archives, by https://pkware.cachefly.net/webdocs/casestudies/APPNOTE.TXT: the central directory, entries without compression and
// deflated ones, and the long sizes and places of Zip64.
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>

#include "engine/core/random_access_file.h"
#include "engine/volume/file_store.h"
#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

constexpr std::uint32_t kEndOfDirectory = 0x06054b50, kZip64Locator = 0x07064b50, kZip64End = 0x06064b50, kDirectoryEntry = 0x02014b50,
                        kLocalEntry = 0x04034b50;
constexpr std::uint64_t kLong = 0xffffffff;  ///< in place of a number of 32 bits that is in the fields of Zip64

/// Numbers in little-endian bytes, of which none is read beyond their end.
class ZipFields {
 public:
  explicit ZipFields(std::span<const std::byte> bytes) : bytes_(bytes) {}
  bool has(std::size_t at, std::size_t count) const { return at <= bytes_.size() && count <= bytes_.size() - at; }
  std::uint64_t number(std::size_t at, std::size_t count) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count && has(at, count); ++i) value |= std::uint64_t(bytes_[at + i]) << (8 * i);
    return value;
  }
  std::string text(std::size_t at, std::size_t count) const {
    return has(at, count) ? std::string(reinterpret_cast<const char*>(bytes_.data()) + at, count) : std::string();
  }

 private:
  const std::span<const std::byte> bytes_;
};

struct ZipEntry {
  std::uint64_t method = 0, crc = 0, packed = 0, bytes = 0, place = 0;
  bool isEncrypted = false;
};

class StoredEntry : public StoredFile {
 public:
  StoredEntry(const RandomAccessFile& file, std::uint64_t begin, std::uint64_t bytes) : file_(file), begin_(begin), bytes_(bytes) {}
  std::uint64_t bytes() const override { return bytes_; }
  bool readAt(std::uint64_t offset, std::span<std::byte> part) const override {
    return offset <= bytes_ && part.size() <= bytes_ - offset && file_.readAt(begin_ + offset, part) == part.size();
  }

 private:
  const RandomAccessFile& file_;
  const std::uint64_t begin_, bytes_;
};

class InflatedEntry : public StoredFile {
 public:
  explicit InflatedEntry(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}
  std::uint64_t bytes() const override { return bytes_.size(); }
  bool readAt(std::uint64_t offset, std::span<std::byte> part) const override {
    if (offset > bytes_.size() || part.size() > bytes_.size() - offset) return false;
    std::copy_n(bytes_.begin() + std::ptrdiff_t(offset), part.size(), part.begin());
    return true;
  }

 private:
  const std::vector<std::byte> bytes_;
};

class ZipStore : public FileStore {
 public:
  explicit ZipStore(const std::filesystem::path& file) : path_(file), file_(file) {
    readDirectory();
    findFolder();
  }

  std::unique_ptr<StoredFile> open(const std::string& name, std::uint64_t most) const override {
    const auto found = entries_.find(folder_ + name);
    if (found == entries_.end()) return nullptr;
    const ZipEntry& entry = found->second;
    if (entry.isEncrypted) fail(ErrorKind::Input, "'{}' is encrypted: write the archive without a password", shown(name));
    if (entry.bytes > most) failDamaged(shown(name), "it is longer than what it can hold");
    const std::uint64_t begin = beginOf(entry, name);
    if (entry.method == 0) return std::make_unique<StoredEntry>(file_, begin, entry.bytes);
    if (entry.method != Z_DEFLATED)
      fail(ErrorKind::Input, "'{}' is compressed by method {} of zip, and only stored and deflated entries are read: write it as such",
           shown(name), entry.method);
    return std::make_unique<InflatedEntry>(inflated(entry, begin, name));
  }

  std::string shown(const std::string& name) const override { return path_.string() + "/" + folder_ + name; }

 private:
  std::vector<std::byte> bytesAt(std::uint64_t offset, std::uint64_t count, const char* what) const {
    if (offset > file_.bytes() || count > file_.bytes() - offset) failDamaged(path_, fmt::format("its {} is beyond its end", what));
    std::vector<std::byte> bytes(count);
    if (file_.readAt(offset, bytes) != count) failDamaged(path_, fmt::format("its {} ends too early", what));
    return bytes;
  }

  /// Where the central directory is, and how long.
  struct Extent {
    std::uint64_t place = 0, bytes = 0;
  };
  Extent directory() const {
    constexpr std::uint64_t kEnd = 22, kLongestComment = 0xffff, kLocator = 20, kLongEnd = 56;
    const std::uint64_t tail = std::min(file_.bytes(), kEnd + kLongestComment), first = file_.bytes() - tail;
    const std::vector<std::byte> bytes = bytesAt(first, tail, "end");
    const ZipFields fields(bytes);
    for (std::uint64_t at = tail >= kEnd ? tail - kEnd + 1 : 0; at-- > 0;) {
      if (fields.number(at, 4) != kEndOfDirectory) continue;
      Extent extent{.place = fields.number(at + 16, 4), .bytes = fields.number(at + 12, 4)};
      if (at >= kLocator && fields.number(at - kLocator, 4) == kZip64Locator) {
        const std::vector<std::byte> end = bytesAt(fields.number(at - kLocator + 8, 8), kLongEnd, "directory of Zip64");
        const ZipFields longFields(end);
        if (longFields.number(0, 4) != kZip64End) failDamaged(path_, "its directory of Zip64 is none");
        extent = {.place = longFields.number(48, 8), .bytes = longFields.number(40, 8)};
      }
      return extent;
    }
    failDamaged(path_, "it is no zip archive");
  }

  /// The numbers of an entry that are in its fields of Zip64.
  static void takeLong(ZipEntry& entry, const ZipFields& fields, std::size_t at, std::size_t end) {
    constexpr std::uint64_t kZip64Field = 1;
    while (at + 4 <= end) {
      const std::uint64_t kind = fields.number(at, 2), size = fields.number(at + 2, 2);
      at += 4;
      std::size_t place = at;
      if (kind == kZip64Field)
        for (std::uint64_t* number : {&entry.bytes, &entry.packed, &entry.place})
          if (*number == kLong && place + 8 <= at + size) {
            *number = fields.number(place, 8);
            place += 8;
          }
      at += size;
    }
  }

  void readDirectory() {
    constexpr std::size_t kEntry = 46;
    constexpr std::uint64_t kLargest = std::uint64_t(1) << 30;
    const Extent extent = directory();
    if (extent.bytes > kLargest) failDamaged(path_, "its directory is too long");
    const std::vector<std::byte> bytes = bytesAt(extent.place, extent.bytes, "directory");
    const ZipFields fields(bytes);
    for (std::size_t at = 0; fields.has(at, kEntry);) {
      if (fields.number(at, 4) != kDirectoryEntry) failDamaged(path_, "its directory has something that is no entry");
      const std::size_t name = fields.number(at + 28, 2), extra = fields.number(at + 30, 2), comment = fields.number(at + 32, 2);
      if (!fields.has(at + kEntry, name + extra + comment)) failDamaged(path_, "its directory ends in an entry");
      ZipEntry entry{.method = fields.number(at + 10, 2),
                     .crc = fields.number(at + 16, 4),
                     .packed = fields.number(at + 20, 4),
                     .bytes = fields.number(at + 24, 4),
                     .place = fields.number(at + 42, 4),
                     .isEncrypted = (fields.number(at + 8, 2) & 1) != 0};
      takeLong(entry, fields, at + kEntry + name, at + kEntry + name + extra);
      entries_[fields.text(at + kEntry, name)] = entry;
      at += kEntry + name + extra + comment;
    }
  }

  void findFolder() {
    if (entries_.empty()) return;
    const std::string& first = entries_.begin()->first;
    const std::string folder = first.substr(0, first.find('/') + 1);
    const bool isCommon = !folder.empty() && std::ranges::all_of(entries_, [&](const auto& one) { return one.first.starts_with(folder); });
    if (isCommon) folder_ = folder;
  }

  std::uint64_t beginOf(const ZipEntry& entry, const std::string& name) const {
    constexpr std::uint64_t kLocal = 30;
    const std::vector<std::byte> bytes = bytesAt(entry.place, kLocal, "entry");
    const ZipFields fields(bytes);
    if (fields.number(0, 4) != kLocalEntry) failDamaged(shown(name), "its place in the archive is wrong");
    const std::uint64_t begin = entry.place + kLocal + fields.number(26, 2) + fields.number(28, 2);
    if (begin > file_.bytes() || entry.packed > file_.bytes() - begin || (entry.method == 0 && entry.packed != entry.bytes))
      failDamaged(shown(name), "its sizes in the archive are wrong");
    return begin;
  }

  std::vector<std::byte> inflated(const ZipEntry& entry, std::uint64_t begin, const std::string& name) const {
    checkPayload(shown(name), entry.bytes, entry.packed, true);
    if (std::max(entry.packed, entry.bytes) > kLong) failDamaged(shown(name), "it is deflated, and longer than 4 GiB");
    std::vector<std::byte> packed = bytesAt(begin, entry.packed, "entry"), bytes(entry.bytes);
    z_stream stream{};
    stream.next_in = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_in = uInt(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = uInt(bytes.size());
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
    const int result = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    if (result != Z_STREAM_END || stream.avail_out != 0) failDamaged(shown(name), "it cannot be inflated");
    if (crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != entry.crc)
      failDamaged(shown(name), "its checksum is wrong");
    return bytes;
  }

  const std::filesystem::path path_;
  const RandomAccessFile file_;
  std::map<std::string, ZipEntry> entries_;
  std::string folder_;  ///< that all entries are in, with "/"; else empty
};

}  // namespace

std::unique_ptr<FileStore> openZipStore(const std::filesystem::path& file) {
  return std::make_unique<ZipStore>(file);
}

}  // namespace freevoxels
