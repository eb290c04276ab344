#include "tests/commands/program_runner.h"

#include <fcntl.h>
#include <pty.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <sstream>
#include <thread>

namespace freevoxels::test {

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string contents(std::FILE* file) {
  std::string text;
  std::array<char, 4096> part;
  std::rewind(file);
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), file))
    text.append(part.data(), count);
  return text;
}

pid_t start(const char* program, const Arguments& arguments, int out, int err) {
  const pid_t child = fork();
  if (child != 0) return child;
  std::vector<char*> argv{const_cast<char*>(program)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  execv(program, argv.data());
  _exit(127);
}

/// Fills all but what the program printed.
void waitFor(pid_t child, ProgramResult& result) {
  int status = 0;
  rusage usage{};
  result.exitCode = 127;
  if (child < 0 || wait4(child, &status, 0, &usage) != child) return;
  result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  result.peakBytes = std::uint64_t(usage.ru_maxrss) * 1024;
}

}  // namespace

ProgramResult runProgramFile(const char* program, const Arguments& arguments) {
  const File out(std::tmpfile()), err(std::tmpfile());
  ProgramResult result;
  waitFor(start(program, arguments, fileno(out.get()), fileno(err.get())), result);
  result.out = contents(out.get());
  result.err = contents(err.get());
  return result;
}

ProgramResult runFreevoxels(const Arguments& arguments) {
  return runProgramFile(FREEVOXELS_PROGRAM, arguments);
}

bool terminalsAvailable() {
  int terminal = -1, program = -1;
  if (openpty(&terminal, &program, nullptr, nullptr, nullptr) != 0) return false;
  close(terminal);
  close(program);
  return true;
}

ProgramResult runFreevoxelsOnTerminal(const Arguments& arguments) {
  const File out(std::tmpfile());
  int terminal = -1, program = -1;
  if (openpty(&terminal, &program, nullptr, nullptr, nullptr) != 0)
    return {.exitCode = 127, .out = "", .err = "", .peakBytes = 0};
  const pid_t child = start(FREEVOXELS_PROGRAM, arguments, fileno(out.get()), program);
  close(program);

  ProgramResult result;
  std::array<char, 4096> part;
  // A terminal whose other end was closed reads as an error.
  for (ssize_t count; (count = read(terminal, part.data(), part.size())) > 0;)
    result.err.append(part.data(), std::size_t(count));
  close(terminal);
  waitFor(child, result);
  result.out = contents(out.get());
  return result;
}

ProgramResult runAndInterrupt(const Arguments& arguments, int signal, int milliseconds) {
  const File out(std::tmpfile()), err(std::tmpfile());
  const pid_t child = start(FREEVOXELS_PROGRAM, arguments, fileno(out.get()), fileno(err.get()));
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  if (child > 0) kill(child, signal);
  ProgramResult result;
  waitFor(child, result);
  result.out = contents(out.get());
  result.err = contents(err.get());
  return result;
}

Arguments words(const TemporaryFolder& folder, const std::string& words) {
  Arguments arguments;
  std::istringstream stream(words);
  for (std::string word; stream >> word;)
    arguments.push_back(word.starts_with('@') ? (folder / word.substr(1)).string() : word);
  return arguments;
}

std::string exrAttribute(const std::string& bytes, const std::string& name) {
  const std::string start = name + '\0' + "string" + '\0';
  const std::size_t at = bytes.find(start);
  if (at == std::string::npos) return "";
  const std::size_t length = at + start.size();
  std::size_t count = 0;
  for (int i = 3; i >= 0; --i)
    count = count * 256 + static_cast<unsigned char>(bytes[length + std::size_t(i)]);
  return bytes.substr(length + 4, count);
}

Arguments recordedCommand(const std::string& bytes, const std::filesystem::path& output) {
  std::istringstream command(exrAttribute(bytes, "freevoxels:command"));
  Arguments arguments;
  for (std::string word; command >> word;) arguments.push_back(word);
  EXPECT_EQ(std::ranges::count(arguments, "image.exr"), 1) << command.str();
  EXPECT_TRUE(command.str().starts_with("freevoxels ")) << command.str();
  std::ranges::replace(arguments, "image.exr", output.string());
  if (!arguments.empty()) arguments.erase(arguments.begin());
  return arguments;
}

void expectSuccess(const ProgramResult& result) {
  EXPECT_EQ(result.exitCode, 0) << result.err;
}

void expectRefusal(const ProgramResult& result, ExitCode code, const std::string& mention) {
  EXPECT_EQ(result.exitCode, int(code)) << result.err;
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  EXPECT_TRUE(result.err.starts_with("freevoxels: ")) << result.err;
  EXPECT_NE(result.err.find(mention), std::string::npos)
      << "'" << mention << "' should be in: " << result.err;
  EXPECT_EQ(result.out, "");
}

void CommandTest::expectCleanRefusal(const std::string& text, ExitCode code,
                                     const std::string& mention) const {
  SCOPED_TRACE(text);
  const std::size_t before = folder.fileCount();
  expectRefusal(run(text), code, mention);
  EXPECT_EQ(folder.fileCount(), before) << "files were left behind";
}

}  // namespace freevoxels::test
