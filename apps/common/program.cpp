#include "apps/common/program.h"

#include <fmt/ranges.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "apps/common/crash_report.h"
#include "apps/common/failure.h"
#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/core/nearest_name.h"
#include "engine/core/printable.h"

namespace freevoxels {

namespace {

/// "%*" in the pattern: the message, marked where it is a warning, without control characters of names from files.
class MessageText : public spdlog::custom_flag_formatter {
 public:
  explicit MessageText(std::string start) : start_(std::move(start)) {}
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& text) override {
    const bool isWarning = message.level == spdlog::level::warn;
    const std::string shown = fmt::format("{}: {}{}", start_, isWarning ? "warning: " : "",
                                          printable(std::string_view(message.payload.data(), message.payload.size())));
    text.append(shown.data(), shown.data() + shown.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<MessageText>(start_); }

 private:
  const std::string start_;
};

void setUpMessages(const std::string& program) {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(program, std::make_shared<spdlog::sinks::stderr_sink_mt>()));
  beginMessagesWith(program);
}

/// How a program ended; the sentence of an error.
struct Outcome {
  ExitCode code = ExitCode::Success;
  std::string sentence;
};

/// Returns success if everything that was printed was written.
Outcome finish() {
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return {};
  return {ExitCode::Output, "cannot write to standard output: is the disk full?"};
}

/// The command as far as it was parsed: "freevoxels render".
std::string commandName(const CLI::App& app) {
  const auto subcommands = app.get_subcommands();
  return subcommands.empty() ? app.get_name() : app.get_name() + " " + subcommands.front()->get_name();
}

/// The command that the arguments name, or the program itself.
const CLI::App& commandOf(const CLI::App& app) {
  const auto subcommands = app.get_subcommands();
  return subcommands.empty() ? app : *subcommands.front();
}

std::vector<std::string> commandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) names.push_back(command->get_name());
  return names;
}

using Arguments = std::vector<std::string>;

/// The command that the words name, or the program itself, before they are parsed.
const CLI::App& commandIn(const CLI::App& app, const Arguments& words) {
  const auto first = std::ranges::find_if(words, [](const std::string& word) { return !word.starts_with('-'); });
  if (first == words.end()) return app;
  const auto named = app.get_subcommands([&](const CLI::App* command) { return command->get_name() == *first; });
  return named.empty() ? app : *named.front();
}

/// One name of each of the command's options that has one that begins with `start`.
Arguments optionsBeginningWith(const CLI::App& command, const std::string& start) {
  Arguments names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames())
      if (("--" + name).starts_with(start)) {
        names.push_back("--" + name);
        break;
      }
  return names;
}

/// "--res=64" and its name alone, "--res", where it is an option that the command does not have; else nothing.
std::optional<std::string> unknownOptionName(const CLI::App& command, const std::string& word) {
  std::string name = word.substr(0, word.find('='));
  if (!name.starts_with("--") || name.size() == 2 || command.get_option_no_throw(name) != nullptr) return std::nullopt;
  return name;
}

/// Completes beginnings of options that only one option has: "--res" is --resolution.
void completeOptions(const CLI::App& app, Arguments& words) {
  const CLI::App& command = commandIn(app, words);
  for (std::string& word : words) {
    if (word == "--") return;  // what follows are no options
    const std::optional<std::string> name = unknownOptionName(command, word);
    if (!name) continue;
    if (const Arguments meant = optionsBeginningWith(command, *name); meant.size() == 1) word.replace(0, name->size(), meant.front());
  }
}

/// "there is no option '--szie'; did you mean '--size'?" for the first word that is like an option and is none; else empty.
std::string unknownOption(const CLI::App& command, const Arguments& words) {
  for (const std::string& word : words) {
    const std::optional<std::string> name = unknownOptionName(command, word);
    if (!name) continue;
    if (const Arguments meant = optionsBeginningWith(command, *name); meant.size() > 1)
      return fmt::format("'{}' is the beginning of {}: write more of it", *name, fmt::join(meant, ", "));
    return fmt::format("there is no option '{}'{}", *name, suggestion(*name, optionsBeginningWith(command, "--")));
  }
  return "";
}

/// The message for a first word that is not a command.
std::string unknownCommand(const CLI::App& app, const std::string& word) {
  if (word.ends_with(".vdb") || word.ends_with(".fvx") || std::filesystem::is_regular_file(word))
    return fmt::format("'{}' is a file, not a command; to draw it: {} render {} image.png", word, app.get_name(), word);
  return fmt::format("there is no command '{}'{}", word, suggestion(word, commandNames(app)));
}

Outcome usageError(const CLI::App& app, const CLI::ParseError& error, const Arguments& words) {
  std::string sentence = error.what();
  const bool hasCommands = !commandNames(app).empty();
  const CLI::App& command = commandOf(app);
  if (hasCommands && &command == &app && !words.empty() && !words.front().starts_with('-'))
    sentence = unknownCommand(app, words.front());
  else if (const std::string unknown = unknownOption(command, words); !unknown.empty())
    sentence = unknown;
  else if (hasCommands && words.empty())
    sentence = "a command is needed";
  if (sentence.size() > 1 && std::islower(static_cast<unsigned char>(sentence[1])))
    sentence[0] = char(std::tolower(static_cast<unsigned char>(sentence[0])));
  return {ExitCode::Usage, fmt::format("{} (see {} --help)", sentence, commandName(app))};
}

Outcome parseAndRun(CLI::App& app, Arguments words) {
  completeOptions(app, words);
  try {
    app.parse(Arguments(words.rbegin(), words.rend()));  // CLI11 takes the last word first
    return finish();
  } catch (const CLI::Success& help) {
    app.exit(help);
    return finish();
  } catch (const CLI::ParseError& error) {
    return usageError(app, error, words);
  } catch (...) {
    const Failure failure = currentFailure();
    if (failure.code == ExitCode::Internal && std::ferror(stdout) != 0) return finish();
    return {failure.code, failure.sentence};
  }
}

std::atomic<int> deferredSignal = 0;
static_assert(decltype(deferredSignal)::is_always_lock_free);  // for the handler

extern "C" void deferSignal(int signal) {
  deferredSignal = signal;
}

constexpr std::array kDeferred{SIGINT, SIGTERM, SIGHUP};

/// The first instance installs the handlers, the last one restores the previous ones.
struct Deferring {
  std::mutex mutex;
  std::condition_variable ended;  ///< notified when `count` becomes 0
  int count = 0;
  std::array<struct sigaction, kDeferred.size()> before;
} deferring;

thread_local int countOfThread = 0;

}  // namespace

std::string programVersion() {
  return FREEVOXELS_PROGRAM_VERSION;
}

void beginMessagesWith(const std::string& start) {
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<MessageText>('*', start).set_pattern("%*");
  spdlog::default_logger()->set_formatter(std::move(formatter));
}

int runProgram(CLI::App& app, int argc, char** argv, const std::function<void()>& onFailure) {
  reportCrashes(app.get_name());
  setUpMessages(app.get_name());
  app.get_formatter()->column_width(36);
  app.get_formatter()->label("REQUIRED", "");
  app.get_formatter()->label("TEXT", "");
  app.set_version_flag("--version", app.get_name() + " " + programVersion());
  Outcome outcome = parseAndRun(app, Arguments(argv + 1, argv + argc));
  if (outcome.code != ExitCode::Success) {
    if (onFailure) onFailure();
    std::ranges::replace(outcome.sentence, '\n', ' ');
    spdlog::error("{}", outcome.sentence);
  }
  return int(outcome.code);
}

void MessageOptions::add(CLI::App& app) {
  CLI::Option* less = app.add_flag("--quiet,-q", quiet, "Print errors only")->group("Messages");
  app.add_flag("--verbose,-v", verbose, "Print the resolved options, stage times, memory and block counts")
      ->excludes(less)
      ->group("Messages");
}

void MessageOptions::apply() const {
  spdlog::set_level(quiet ? spdlog::level::err : verbose ? spdlog::level::debug : spdlog::level::info);
}

DeferredInterrupts::DeferredInterrupts() {
  std::unique_lock lock(deferring.mutex);
  if (countOfThread++ == 0) deferring.ended.wait(lock, [] { return deferring.count == 0 || deferredSignal == 0; });
  if (deferring.count++ > 0) return;
  struct sigaction defer {};
  defer.sa_handler = deferSignal;
  defer.sa_flags = SA_RESTART;  // of calls that write, on file systems where signals interrupt these
  for (std::size_t i = 0; i < kDeferred.size(); ++i) sigaction(kDeferred[i], &defer, &deferring.before[i]);
}

DeferredInterrupts::~DeferredInterrupts() {
  const std::lock_guard lock(deferring.mutex);
  --countOfThread;
  if (--deferring.count > 0) return;
  for (std::size_t i = 0; i < kDeferred.size(); ++i) sigaction(kDeferred[i], &deferring.before[i], nullptr);
  // Locked, so that no thread that waits can defer the signal again.
  if (const int signal = deferredSignal.exchange(0); signal != 0) std::raise(signal);
  deferring.ended.notify_all();
}

void checkDistinct(const std::vector<std::string>& files) {
  std::map<std::string, std::string> known;  // what tells a file from others, and its name
  const auto note = [&](const std::string& identity, const std::string& file) {
    const auto [first, isNew] = known.emplace(identity, file);
    if (!isNew) fail(ErrorKind::Usage, "'{}' and '{}' are the same file: give every input and output its own", first->second, file);
  };
  for (const std::string& file : files) {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::weakly_canonical(file, error);
    if (!error) note(path.string(), file);
    struct stat status {};
    if (stat(file.c_str(), &status) == 0)  // detects two names of one file
      note(fmt::format("{}:{}", status.st_dev, status.st_ino), file);
  }
}

void checkOutput(const std::filesystem::path& file) {
  const DeferredInterrupts noTemporaryStays;
  checkWritable(file);
}

}  // namespace freevoxels
