#pragma once
// Pictures made beside the window, so that it never waits for them.

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "apps/view/picture_maker.h"
#include "engine/core/error.h"

namespace freevoxels {

class RenderThread {
 public:
  struct Result {
    std::uint64_t number = 0;                ///< of the request
    std::shared_ptr<const Picture> picture;  ///< null where it failed
    std::string problem;                     ///< then the sentence that says why
    ExitCode code = ExitCode::Success;       ///< and what `freevoxels render` would end with
  };

  /// On a device that other threads use as well. `finished` is called by the thread whenever there is a result.
  RenderThread(const Device& device, VolumeCache& volumes, std::function<void()> finished);
  /// Abandons the picture that is being made, and waits until the device has completed the slice that it is executing.
  ~RenderThread();
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  /// Takes the place of a request that has not been begun.
  void ask(PictureRequest request);
  /// Abandons the picture that is being made and the request that waits, if any: no result comes of them.
  void abandon();
  /// How long the picture that is being made has taken by now; 0 while none is.
  std::chrono::milliseconds busyFor() const;
  /// The last one since the last call.
  std::optional<Result> take();
  /// What it is doing, and how much of that is done; nothing while it waits, or has just begun.
  std::optional<std::pair<std::string, double>> activity() const;

 private:
  void run();
  std::optional<Result> answer(const PictureRequest& request);
  std::shared_ptr<const Picture> makePicture(const PictureRequest& request);

  const Device& device_;
  VolumeCache& volumes_;
  const std::function<void()> finished_;
  std::unique_ptr<PictureMaker> maker_;
  std::unique_ptr<PictureMaker> comparing_;  ///< with another table

  mutable std::mutex mutex_;  ///< of all below
  std::condition_variable asked_;
  bool ends_ = false, busy_ = false, abandons_ = false;
  std::optional<PictureRequest> waiting_;
  std::optional<Result> result_;
  std::optional<std::pair<std::string, double>> activity_;
  std::chrono::steady_clock::time_point begun_;
  std::thread thread_;
};

}  // namespace freevoxels
