#pragma once
// Common behaviour of all programs: messages, exit codes, interrupts.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace freevoxels {

/// "0.1.0"
std::string programVersion();

/// Parses the arguments and runs the command that they name. Options may be shortened to a unique beginning.
/// Every exception and crash becomes one line on stderr and its ExitCode; `onFailure` is called before it is
/// printed. Adds --version to `app`.
int runProgram(CLI::App& app, int argc, char** argv, const std::function<void()>& onFailure = {});

/// Puts `start` and ": " before each message that follows. Control characters of names from files are escaped in messages.
void beginMessagesWith(const std::string& start);

/// --quiet and --verbose.
struct MessageOptions {
  bool quiet = false, verbose = false;

  void add(CLI::App& app);
  void apply() const;
};

/// As long as one exists, SIGINT, SIGTERM and SIGHUP are deferred, so that an output that is being written is
/// completed instead of left as a temporary file. The deferred signal then ends the program. Any thread may
/// have one, which ends in the same thread. Once a signal is deferred, no other thread's begins: its constructor waits for all to end.
class DeferredInterrupts {
 public:
  DeferredInterrupts();
  ~DeferredInterrupts();
  DeferredInterrupts(const DeferredInterrupts&) = delete;
  DeferredInterrupts& operator=(const DeferredInterrupts&) = delete;
};

/// Calls checkWritable, which creates a temporary file, safe from interrupts.
void checkOutput(const std::filesystem::path& file);

/// Fails with ErrorKind::Usage if two of the names refer to the same file, so that no output replaces an input
/// or another output.
void checkDistinct(const std::vector<std::string>& files);

}  // namespace freevoxels
