#pragma once
// One piece of work beside the window, which can be given up.

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "engine/core/stages.h"

namespace freevoxels {

class ExportJob {
 public:
  using Work = std::function<void(const Progress&)>;
  struct Outcome {
    bool done = false;     ///< all of it
    std::string sentence;  ///< what was done, or why it was not
  };

  /// `finished` is called by the thread at the end of every piece of work.
  explicit ExportJob(std::function<void()> finished);
  /// Cancels, and waits for what cannot be given up.
  ~ExportJob();
  ExportJob(const ExportJob&) = delete;
  ExportJob& operator=(const ExportJob&) = delete;

  /// `done` is the sentence to say then. Not while there is another: busy().
  void start(Work work, std::string done);
  /// Where the work next says how far it is.
  void cancel() { cancelled_ = true; }
  bool busy() const;
  /// Once, after the end of the work.
  std::optional<Outcome> take();
  /// What it is doing, and how much of all is done.
  std::pair<std::string, double> activity() const;

 private:
  Outcome outcomeOf(const Work& work, const std::string& done);

  const std::function<void()> finished_;
  std::atomic<bool> cancelled_ = false;
  mutable std::mutex mutex_;  ///< of all below
  bool busy_ = false;
  std::optional<Outcome> outcome_;
  std::pair<std::string, double> activity_;
  std::thread thread_;
};

}  // namespace freevoxels
