#pragma once
// Makes images in another thread, so that the window never waits for them.

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "apps/view/image_maker.h"

namespace freevoxels {

class RenderThread {
 public:
  struct Result {
    std::uint64_t number = 0;                ///< number of the request
    std::shared_ptr<const DrawnImage> drawn;  ///< null if it failed
    std::string problem;                     ///< the reason for a failure
    std::exception_ptr failure;              ///< what was thrown in this case
  };

  /// On a device that other threads use as well. `finished` is called by the thread whenever there is a result.
  RenderThread(const Device& device, VolumeCache& volumes, std::function<void()> finished);
  /// Abandons the image that is being made, and waits until the device has completed the slice that it is executing.
  ~RenderThread();
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  /// Replaces a request that has not been started.
  void ask(ImageRequest request);
  /// Abandons the image that is being made and the request that waits, if any: no result comes of them.
  void abandon();
  /// Abandons everything, for good, without waiting for that.
  void end();
  /// How long the image that is being made has taken by now; 0 while none is.
  std::chrono::milliseconds busyFor() const;
  bool isBusy() const;
  /// The last result since the last call.
  std::optional<Result> take();
  /// The current stage and the fraction of it that is done; nothing while it waits or has just started.
  std::optional<std::pair<std::string, double>> activity() const;

 private:
  void run();
  std::optional<Result> answer(const ImageRequest& request);
  std::shared_ptr<const DrawnImage> makeImage(const ImageRequest& request);

  const Device& device_;
  VolumeCache& volumes_;
  const std::function<void()> finished_;
  std::unique_ptr<ImageMaker> maker_;
  std::unique_ptr<ImageMaker> comparing_;  ///< for methods with another table

  mutable std::mutex mutex_;  ///< guards all members below
  std::condition_variable asked_;
  bool ends_ = false, busy_ = false, abandons_ = false;
  std::optional<ImageRequest> waiting_;
  std::optional<Result> result_;
  std::optional<std::pair<std::string, double>> activity_;
  std::chrono::steady_clock::time_point begun_;
  std::thread thread_;
};

}  // namespace freevoxels
