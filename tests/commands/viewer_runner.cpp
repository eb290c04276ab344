#include "tests/commands/viewer_runner.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <sstream>
#include <thread>

#include "engine/image/srgb.h"

namespace freevoxels::test {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kLongest{60};  // after which a test fails rather than hangs

/// Whether it came true.
bool waitUntil(const std::function<bool()>& isTrue) {
  const auto end = std::chrono::steady_clock::now() + kLongest;
  while (std::chrono::steady_clock::now() < end) {
    if (isTrue()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

void become(const std::string& program, const Arguments& arguments) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  _exit(127);
}

}  // namespace

std::optional<std::string> installedProgram(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/" + name).c_str(), X_OK) == 0) return folder + "/" + name;
  return std::nullopt;
}

Display::Display() : memory_(fs::temp_directory_path() / fmt::format("freevoxels-display-{}", getpid())) {
  fs::create_directories(memory_);
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  server_ = fork();
  if (server_ == 0) {
    const int silent = ::open("/dev/null", O_WRONLY);
    dup2(silent, STDERR_FILENO);
    close(ends[0]);
    become(installedProgram("Xvfb").value(), {"-displayfd", std::to_string(ends[1]), "-screen", "0",
                                              "1400x900x24", "-nolisten", "tcp", "-noreset", "-fbdir", memory_.string()});
  }
  close(ends[1]);
  std::string number;
  pollfd ready{ends[0], POLLIN, 0};
  for (char c = 0; poll(&ready, 1, 30'000) == 1 && read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
  close(ends[0]);
  if (number.empty()) throw std::runtime_error("Xvfb does not start");
  setenv("DISPLAY", (":" + number).c_str(), 1);
}

Display::~Display() {
  unsetenv("DISPLAY");
  kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
  std::error_code ignored;
  fs::remove_all(memory_, ignored);
}

Image Display::screen() const {
  // An X window dump: a header of big-endian words, a table of colours, and rows of blue, green, red and padding.
  const std::string dump = readBytes(memory_ / "Xvfb_screen0");
  const auto word = [&](std::size_t i) {
    std::size_t value = 0;
    for (std::size_t byte = 4 * i; byte < 4 * i + 4; ++byte) value = value << 8 | std::uint8_t(dump.at(byte));
    return value;
  };
  const std::size_t headerBytes = word(0), rowBytes = word(12), colors = word(19), bytesPerColor = 12;
  Image image{.size = glm::ivec2(int(word(4)), int(word(5)))};
  for (int y = 0; y < image.size.y; ++y)
    for (int x = 0; x < image.size.x; ++x) {
      const std::size_t at = headerBytes + colors * bytesPerColor + std::size_t(y) * rowBytes + 4 * std::size_t(x);
      const auto linear = [&](std::size_t byte) { return linearFromSrgb(float(std::uint8_t(dump.at(at + byte))) / 255.0f); };
      image.pixels.emplace_back(linear(2), linear(1), linear(0), 1.0f);
    }
  return image;
}

ViewerSession::ViewerSession(const fs::path& folder, const Arguments& arguments) : folder_(folder) {
  child_ = fork();
  if (child_ == 0) {
    if (chdir(folder.c_str()) != 0) _exit(126);
    dup2(::open("said.txt", O_CREAT | O_WRONLY, 0600), STDERR_FILENO);
    setenv("XDG_STATE_HOME", folder.c_str(), 1);
    become(FREEVOXELS_VIEW_PROGRAM, arguments);
  }
  const Arguments search{"search", "--all", "--onlyvisible", "--pid", std::to_string(child_), "--name", "FreeVoxels"};
  EXPECT_TRUE(waitUntil([&] {
    std::istringstream(runProgramFile(installedProgram("xdotool")->c_str(), search).out) >> window_;
    return !window_.empty() || waitpid(child_, nullptr, WNOHANG) == child_;
  }));
  EXPECT_FALSE(window_.empty()) << "no window: " << readBytes(folder / "said.txt");
  hands("mousemove 700 300");  // keys go to the window under the mouse
}

ViewerSession::~ViewerSession() {
  if (child_ < 0) return;
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

void ViewerSession::hands(const std::string& words) const {
  Arguments arguments;
  std::istringstream stream(words);
  for (std::string word; stream >> word;) arguments.push_back(word == "@" ? window_ : word);
  const ProgramResult result = runProgramFile(installedProgram("xdotool")->c_str(), arguments);
  EXPECT_EQ(result.exitCode, 0) << words << ": " << result.err;
}

void ViewerSession::type(char shortcut, const std::string& text) const {
  hands(std::string("key --delay 1 ctrl+") + shortcut + " type --delay 1 " + text);
  hands("key Return");
}

void ViewerSession::saveAll(char shortcut, const std::string& pattern, const std::string& last) const {
  type(shortcut, pattern);
  EXPECT_TRUE(waitUntil([&] { return fs::exists(folder_ / last); }))
      << last << " is not saved: " << readBytes(folder_ / "said.txt");
}

std::string ViewerSession::save(char shortcut, const std::string& name) const {
  saveAll(shortcut, name, name);
  return readBytes(folder_ / name);
}

void ViewerSession::open(const std::string& name) const {
  type('o', name);
}

ProgramResult ViewerSession::quit() {
  hands("key ctrl+q");
  ProgramResult result;
  int status = 0;
  if (waitUntil([&] { return waitpid(child_, &status, WNOHANG) == child_; })) {
    child_ = -1;
    result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  } else {
    ADD_FAILURE() << "it does not end";
  }
  result.err = readBytes(folder_ / "said.txt");
  return result;
}

}  // namespace freevoxels::test
