#include "engine/core/random_access_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <vector>

#include "engine/core/spool.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

namespace fs = std::filesystem;

std::string readOf(const RandomAccessFile& file, std::uint64_t offset, std::size_t count) {
  std::string text(count, '?');
  text.resize(file.readAt(offset, std::as_writable_bytes(std::span(text))));
  return text;
}

int errorOfOpening(const fs::path& path) {
  try {
    const RandomAccessFile file(path);
    return 0;
  } catch (const std::system_error& error) {
    return error.code().value();
  }
}

TEST(RandomAccessFile, ReadsAnyPartAndAsMuchAsThereIs) {
  const test::TemporaryFolder folder;
  test::writeBytes(folder / "a", "0123456789");
  const RandomAccessFile file(folder / "a");
  EXPECT_EQ(file.bytes(), 10u);
  EXPECT_EQ(readOf(file, 3, 4), "3456");
  EXPECT_EQ(readOf(file, 8, 4), "89");
  EXPECT_EQ(readOf(file, 10, 4), "");
  EXPECT_EQ(readOf(file, 100, 4), "");
  EXPECT_EQ(readOf(file, 0, 0), "");
}

TEST(RandomAccessFile, SaysWhyAFileCannotBeReadAndDoesNotWaitForPipes) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(errorOfOpening(folder / "none"), ENOENT);
  EXPECT_EQ(errorOfOpening(folder.path()), EISDIR);
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(errorOfOpening(folder / "pipe"), EINVAL);
}

TEST(RandomAccessFile, KnowsWhetherItWasCutOrWrittenToButNotWhetherItsNameWasTaken) {
  const test::TemporaryFolder folder;
  test::writeBytes(folder / "a", "0123456789");
  const RandomAccessFile file(folder / "a");
  test::writeBytes(folder / "b", "other");
  fs::rename(folder / "b", folder / "a");
  EXPECT_FALSE(file.hasChanged());
  EXPECT_EQ(readOf(file, 3, 4), "3456");
  const RandomAccessFile other(folder / "a");
  fs::resize_file(folder / "a", 2);
  EXPECT_TRUE(other.hasChanged());
  EXPECT_EQ(readOf(other, 0, 4), "ot");
}

/// The file behind a spool, which has no name.
fs::path fileOfSpool() {
  for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    if (fs::read_symlink(entry.path(), error).string().find(".freevoxels-spool.") != std::string::npos) return entry.path();
  }
  return {};
}

TEST(Spool, ThatWasCutSaysThatItCannotBeReadWhateverWentWrongBefore) {
  const test::TemporaryFolder folder;
  Spool spool(folder.path());
  const std::vector<std::byte> bytes(5000, std::byte(7));
  spool.append(bytes);
  spool.flush();
  std::vector<std::byte> read(bytes.size());
  spool.readAt(0, read);
  EXPECT_EQ(read, bytes);
  const fs::path file = fileOfSpool();
  ASSERT_FALSE(file.empty());
  fs::resize_file(file, 3000);
  for (const int before : {0, ENOENT, EAGAIN}) {
    errno = before;
    try {
      spool.readAt(1000, read);
      FAIL() << "no error";
    } catch (const std::system_error& error) {
      EXPECT_EQ(error.code().value(), EIO) << error.what();
    }
  }
}

}  // namespace
}  // namespace freevoxels
