#pragma once
// What every program does the same way: messages, exit codes, interrupts.

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

/// Parses the arguments and runs the command they name; its callbacks throw. Options may be given by their beginning where no
/// other one begins so. Every error, crashes included, becomes one line on stderr and its ExitCode; `onFailure` is called before
/// it is printed. Adds --version to `app`.
int runProgram(CLI::App& app, int argc, char** argv, const std::function<void()>& onFailure = {});

/// --quiet and --verbose.
struct MessageOptions {
  bool quiet = false, verbose = false;

  void add(CLI::App& app);
  void apply() const;
};

/// While one lives, SIGINT, SIGTERM and SIGHUP wait: an output that is being written is finished, not left as
/// a temporary file. A signal that came meanwhile ends the program afterwards. Any thread may have one.
class DeferredInterrupts {
 public:
  DeferredInterrupts();
  ~DeferredInterrupts();
  DeferredInterrupts(const DeferredInterrupts&) = delete;
  DeferredInterrupts& operator=(const DeferredInterrupts&) = delete;
};

/// checkWritable, which tries with a temporary file, safe from interrupts.
void checkOutput(const std::filesystem::path& file);

/// ExitCode::Usage where two of the names mean the same file, so that no output replaces an input or another
/// output.
void checkDistinct(const std::vector<std::string>& files);

}  // namespace freevoxels
