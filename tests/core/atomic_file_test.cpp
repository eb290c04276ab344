#include "engine/core/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <new>
#include <stdexcept>
#include <vector>

#include "engine/core/checked_file.h"
#include "engine/core/error.h"
#include "tests/limited_disk.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::readBytes;
using test::TemporaryFolder;
using test::writeBytes;

bool contains(const Error& error, const std::string& text) {
  return std::string(error.what()).find(text) != std::string::npos;
}

TEST(AtomicFile, WritesWhatTheWriterWrote) {
  const TemporaryFolder folder;
  writeAtomically(folder / "a.txt", [](const fs::path& file) { writeBytes(file, "new"); });
  EXPECT_EQ(readBytes(folder / "a.txt"), "new");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, KeepsTheOldFileUntilTheNewOneIsComplete) {
  const TemporaryFolder folder;
  writeBytes(folder / "a.exr", "old");
  writeAtomically(folder / "a.exr", [&](const fs::path& file) {
    writeBytes(file, "new");
    EXPECT_EQ(readBytes(folder / "a.exr"), "old");
  });
  EXPECT_EQ(readBytes(folder / "a.exr"), "new");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, TheFileBeingWrittenHasNoNameThatAKilledProcessCouldLeave) {
  const TemporaryFolder folder;
  if (const int file = open(folder.path().c_str(), O_TMPFILE | O_RDWR, 0600); file >= 0)
    close(file);
  else
    GTEST_SKIP() << "this file system has no files without a name";
  writeAtomically(folder / "a.exr", [&](const fs::path& file) {
    writeBytes(file, "new");
    EXPECT_EQ(folder.fileCount(), 0u);
  });
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, AReplacedFileKeepsItsModeAndANewOneFollowsTheUmask) {
  const TemporaryFolder folder;
  writeBytes(folder / "old.txt", "old");
  fs::permissions(folder / "old.txt", fs::perms(0640));
  for (const char* name : {"old.txt", "new.txt"})
    writeAtomically(folder / name, [](const fs::path& file) { writeBytes(file, "new"); });
  const mode_t mask = umask(0);
  umask(mask);
  EXPECT_EQ(fs::status(folder / "old.txt").permissions(), fs::perms(0640));
  EXPECT_EQ(fs::status(folder / "new.txt").permissions(), fs::perms(0666 & ~mask));
  EXPECT_EQ(readBytes(folder / "old.txt"), "new");
}

TEST(AtomicFile, ADanglingLinkIsWrittenThrough) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "real");
  fs::create_symlink("real/second", folder / "first");
  fs::create_symlink("file.txt", folder / "real/second");
  checkWritable(folder / "first");
  writeAtomically(folder / "first", [](const fs::path& file) { writeBytes(file, "new"); });
  EXPECT_TRUE(fs::is_symlink(folder / "first"));
  EXPECT_TRUE(fs::is_symlink(folder / "real/second"));
  EXPECT_EQ(readBytes(folder / "real/file.txt"), "new");
  fs::create_symlink("nowhere/file.txt", folder / "broken");
  EXPECT_TRUE(contains(errorOf([&] { checkWritable(folder / "broken"); }), "there is no folder"));
}

/// As two threads do.
TEST(AtomicFile, TwoWritersOfOneNameDoNotDisturbEachOther) {
  const TemporaryFolder folder;
  writeAtomically(folder / "a.exr", [&](const fs::path& outer) {
    writeBytes(outer, "outer");
    writeAtomically(folder / "a.exr", [&](const fs::path& inner) {
      EXPECT_NE(inner, outer);
      writeBytes(inner, "inner");
    });
    EXPECT_EQ(readBytes(outer), "outer");
    EXPECT_EQ(readBytes(folder / "a.exr"), "inner");
  });
  EXPECT_EQ(readBytes(folder / "a.exr"), "outer");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, LeavesNothingBehindAndTheOldFileWholeWhenTheWriterFails) {
  const TemporaryFolder folder;
  writeBytes(folder / "a.exr", "old");
  const Error error = errorOf([&] {
    writeAtomically(folder / "a.exr", [](const fs::path& file) {
      writeBytes(file, "half of it");
      throw std::runtime_error("The encoder gave up.\n");
    });
  });
  EXPECT_EQ(error.kind(), ErrorKind::Output);
  EXPECT_TRUE(contains(error, "cannot write '" + (folder / "a.exr").string() + "': The encoder gave up; "))
      << error.what();
  EXPECT_EQ(readBytes(folder / "a.exr"), "old");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, PassesErrorsOfUsersAndProgrammersAndMemoryAsTheyAre) {
  const TemporaryFolder folder;
  const auto write = [&](auto exception) {
    writeAtomically(folder / "a", [&](const fs::path&) { throw exception; });
  };
  EXPECT_EQ(errorOf([&] { write(Error(ErrorKind::Input, "no")); }).kind(), ErrorKind::Input);
  EXPECT_THROW(write(InternalError("bug")), InternalError);
  EXPECT_THROW(write(std::bad_alloc()), std::bad_alloc);
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(AtomicFile, SaysSoWhenTheWriterWroteNothing) {
  const TemporaryFolder folder;
  const Error error = errorOf([&] { writeAtomically(folder / "a", [](const fs::path&) {}); });
  EXPECT_EQ(error.kind(), ErrorKind::Output);
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(AtomicFile, WritesThroughASymbolicLink) {
  const TemporaryFolder folder;
  writeBytes(folder / "real.txt", "old");
  fs::create_symlink(folder / "real.txt", folder / "link.txt");
  writeAtomically(folder / "link.txt", [](const fs::path& file) { writeBytes(file, "new"); });
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(readBytes(folder / "real.txt"), "new");
}

TEST(AtomicFile, TakesTheLongestNameThatAFileCanHave) {
  const TemporaryFolder folder;
  const fs::path file = folder / (std::string(251, 'n') + ".exr");
  checkWritable(file);
  writeAtomically(file, [](const fs::path& temporary) { writeBytes(temporary, "x"); });
  EXPECT_EQ(readBytes(file), "x");
}

TEST(AtomicFile, ChecksTheDestinationBeforeAnyWork) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "folder");
  writeBytes(folder / "file", "old");
  const auto refusal = [](const fs::path& file) {
    const Error error = errorOf([&] { checkWritable(file); });
    EXPECT_EQ(error.kind(), ErrorKind::Output) << file;
    EXPECT_TRUE(contains(error, "'" + file.string() + "'")) << error.what();
    return std::string(error.what());
  };
  EXPECT_NE(refusal(folder / "missing/a.exr").find("there is no folder"), std::string::npos);
  EXPECT_NE(refusal(folder / "file/a.exr").find("there is no folder"), std::string::npos);
  EXPECT_NE(refusal(folder / "folder").find("it is a folder"), std::string::npos);
  EXPECT_NE(refusal(folder / "folder/").find("add a file name"), std::string::npos);
  EXPECT_NE(refusal("").find("add a file name"), std::string::npos);
  EXPECT_NE(refusal("/dev/null").find("not a regular file"), std::string::npos);
  EXPECT_NE(refusal("/proc/a.exr").find("choose another folder"), std::string::npos);
  EXPECT_NE(refusal(folder / std::string(300, 'n')).find("choose a shorter name"), std::string::npos);
  EXPECT_NO_THROW(checkWritable(folder / "new.exr"));
  EXPECT_NO_THROW(checkWritable(folder / "file"));
  EXPECT_EQ(readBytes(folder / "file"), "old");
  EXPECT_EQ(folder.fileCount(), 2u);
}

TEST(AtomicFileDeathTest, AFolderThatMayNotBeSearchedIsNotCalledMissing) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const TemporaryFolder folder;
  fs::create_directories(folder / "closed/inner");
  fs::permissions(folder / "closed", fs::perms(0600));
  const auto check = [&] {
    if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) _exit(98);  // root may search any folder
    const Error error = errorOf([&] { checkWritable(folder / "closed/inner/a.exr"); });
    std::fprintf(stderr, "%s\n", error.what());
    _exit(int(error.kind()));
  };
  EXPECT_EXIT(check(), testing::ExitedWithCode(int(ErrorKind::Output)), "Permission denied; change its permissions");
  fs::permissions(folder / "closed", fs::perms(0700));
}

TEST(CheckedFile, ReportsBytesThatFailOnlyWhenTheBufferIsFlushed) {
  CheckedFile file("/dev/full");
  file.write("abc", 3);  // stays in the buffer
  try {
    file.close();
    FAIL() << "no error";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code().value(), ENOSPC);
  }
}

TEST(CheckedFile, ReportsAtCloseWhatWasCaughtBefore) {
  CheckedFile file("/dev/full");
  const std::vector<char> bytes(1 << 20);
  EXPECT_THROW(file.write(bytes.data(), bytes.size()), std::system_error);
  EXPECT_THROW(file.close(), std::system_error);
}

TEST(AtomicFileDeathTest, SaysThatTheDiskIsFull) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const TemporaryFolder folder;
  FV_REQUIRE_LIMITED_DISK(folder.path());
  const auto write = [](const fs::path& disk) {
    writeAtomically(disk / "a.exr", [](const fs::path& file) {
      CheckedFile output(file);
      const std::vector<char> bytes(1 << 20);
      output.write(bytes.data(), bytes.size());
      output.close();
    });
  };
  EXPECT_EXIT(test::exitWithErrorOnLimitedDisk(folder.path(), 65536, write),
              testing::ExitedWithCode(int(ErrorKind::Output)),
              "cannot write '.*a.exr': No space left on device; free some space");
}

TEST(AtomicFileDeathTest, FindsOutThatTheDiskIsFullWhereALibraryDoesNotSay) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const TemporaryFolder folder;
  FV_REQUIRE_LIMITED_DISK(folder.path());
  const auto write = [](const fs::path& disk) {
    writeAtomically(disk / "a.vdb", [](const fs::path& file) {
      writeBytes(file, std::string(1 << 20, 'x'));
      throw std::runtime_error("something is wrong");
    });
  };
  EXPECT_EXIT(test::exitWithErrorOnLimitedDisk(folder.path(), 65536, write),
              testing::ExitedWithCode(int(ErrorKind::Output)),
              "cannot write '.*a.vdb': No space left on device; free some space");
}

}  // namespace
}  // namespace freevoxels
