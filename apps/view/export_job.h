#pragma once
// Work in another thread, which can be cancelled.

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
    bool done = false;     ///< whether all of it was done
    std::string sentence;  ///< what was done, or why it failed
    bool cancelled = false;
  };

  /// `finished` is called by the thread at the end of every job.
  explicit ExportJob(std::function<void()> finished);
  /// Cancels, and waits for what cannot be cancelled.
  ~ExportJob();
  ExportJob(const ExportJob&) = delete;
  ExportJob& operator=(const ExportJob&) = delete;

  /// Starts a job; `done` is the sentence to show at its end. Not while busy().
  void start(Work work, std::string done);
  /// Cancels the job when it next reports progress.
  void cancel() { cancelled_ = true; }
  bool busy() const;
  /// The outcome, once after the end of a job.
  std::optional<Outcome> take();
  /// The current stage, and the fraction of the whole job that is done.
  std::pair<std::string, double> activity() const;

 private:
  Outcome outcomeOf(const Work& work, const std::string& done);

  const std::function<void()> finished_;
  std::atomic<bool> cancelled_ = false;
  mutable std::mutex mutex_;  ///< guards all members below
  bool busy_ = false;
  std::optional<Outcome> outcome_;
  std::pair<std::string, double> activity_;
  std::thread thread_;
};

}  // namespace freevoxels
