#include "apps/common/crash_report.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <new>
#include <system_error>
#include <thread>

#include "apps/common/failure.h"
#include "engine/core/atomic_file.h"
#include "engine/core/crash_note.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

testing::ExitedWithCode exited(ExitCode code) {
  return testing::ExitedWithCode(int(code));
}

void limit(__rlimit_resource resource, rlim_t bytes) {
  const rlimit limits{bytes, bytes};
  if (setrlimit(resource, &limits) != 0) _exit(98);
}

class CrashReportDeathTest : public testing::Test {
 protected:
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

/// Sanitizers report crashes themselves.
class CrashDeathTest : public CrashReportDeathTest {
 protected:
  void SetUp() override {
    CrashReportDeathTest::SetUp();
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers report crashes themselves";
#endif
  }
};

TEST_F(CrashDeathTest, InsideANoteEndsWithItsSentence) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) {
    const auto crash = [signal] {
      reportCrashes("program");
      const CrashNote outer("outer");
      const CrashNote inner("cannot read 'a.vdb': the file is damaged");
      std::raise(signal);
    };
    EXPECT_EXIT(crash(), exited(ExitCode::Input), "^program: cannot read 'a.vdb': the file is damaged\n$");
  }
}

TEST_F(CrashDeathTest, OutsideOfANoteIsAnInternalError) {
  const auto crash = [] {
    reportCrashes("program");
    { const CrashNote note("cannot read 'a.vdb'"); }
    std::raise(SIGSEGV);
  };
  EXPECT_EXIT(crash(), exited(ExitCode::Internal), "^program: internal error, please report it[^\n]*\n$");
}

TEST_F(CrashDeathTest, NotesAreOfTheThreadThatCrashes) {
  const auto crash = [] {
    reportCrashes("program");
    const CrashNote note("the first thread");
    std::thread([] {
      const CrashNote other("the second thread");
      std::raise(SIGSEGV);
    }).join();
  };
  EXPECT_EXIT(crash(), exited(ExitCode::Input), "^program: the second thread\n$");
}

TEST_F(CrashDeathTest, OfAProcessWithLittleAddressSpaceIsCalledWantOfMemory) {
  const auto crash = [] {
    limit(RLIMIT_AS, std::size_t(1) << 32);
    reportCrashes("program");
    std::raise(SIGSEGV);
  };
  EXPECT_EXIT(crash(), exited(ExitCode::OutOfMemory), "4096 MiB .ulimit -v.");
}

TEST_F(CrashReportDeathTest, AnUncaughtExceptionIsASentence) {
  const auto end = [](auto exception) {
    reportCrashes("program");
    std::thread([exception] { throw exception; }).join();
  };
  EXPECT_EXIT(end(Error(ErrorKind::Output, "cannot write 'a.png'")), exited(ExitCode::Output), "^program: cannot write 'a.png'\n$");
  EXPECT_EXIT(end(std::bad_alloc()), exited(ExitCode::OutOfMemory), "^program: [^\n]*memory[^\n]*\n$");
  EXPECT_EXIT(end(std::system_error(EAGAIN, std::generic_category())), exited(ExitCode::OutOfMemory), "threads.*ulimit -u");
  EXPECT_EXIT(end(7), exited(ExitCode::Internal), "^program: internal error[^\n]*\n$");
}

TEST_F(CrashReportDeathTest, AFileBeyondTheSizeLimitIsAnErrorOfTheOutput) {
  const test::TemporaryFolder folder;
  const auto write = [&] {
    reportCrashes("program");
    limit(RLIMIT_FSIZE, 1000);
    const Error error = test::errorOf([&] { writeTextAtomically(folder / "a.json", std::string(5000, ' ')); });
    const bool leftSomething = folder.fileCount() > 0;
    std::filesystem::remove_all(folder.path());
    std::fprintf(stderr, "%s%s\n", leftSomething ? "left something: " : "", error.what());
    _exit(int(exitCodeOf(error.kind())));
  };
  EXPECT_EXIT(write(), exited(ExitCode::Output), "^cannot write '.*a.json': File too large; raise the limit.*ulimit -f");
}

}  // namespace
}  // namespace freevoxels
