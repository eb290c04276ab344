// What ends a program before there are handlers is said by its cause, in one sentence.

#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

TEST(EarlyFailure, IsSaidByItsCause) {
  struct Case {
    const char* kind;
    ExitCode code;
    const char* sentence;
  };
  constexpr const char* kLimits = "raise the limits on threads and memory (ulimit -u, ulimit -v)";
  const Case cases[] = {
      {"bad_alloc", ExitCode::OutOfMemory, kLimits},
      {"threads", ExitCode::OutOfMemory, kLimits},
      {"memory", ExitCode::OutOfMemory, kLimits},
      {"permission", ExitCode::Internal, "internal error, please report it: Operation not permitted"},
      {"error", ExitCode::Input, "cannot read 'a.vdb'"},
      {"runtime_error", ExitCode::Internal, "internal error, please report it: the name\\x0a'A B' is bad"},
      {"logic_error", ExitCode::Internal, "internal error, please report it: "},
      {"int", ExitCode::Internal, "internal error, please report it: an exception of unknown type"},
      {"terminate", ExitCode::Internal, "internal error, please report it: std::terminate was called"}};
  for (const char* when : {"loading", "main"})
    for (const auto& [kind, code, sentence] : cases) {
      SCOPED_TRACE(std::string(when) + " " + kind);
      const ProgramResult result = runProgramFile(FREEVOXELS_EARLY_FAILURE, {when, kind});
      EXPECT_EQ(result.exitCode, int(code));
      EXPECT_EQ(result.err, std::string("freevoxels: the program could not start: ") + sentence + "\n");
      EXPECT_EQ(result.out, "");
    }
}

}  // namespace

}  // namespace freevoxels::test
