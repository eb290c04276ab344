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

  using Make = std::function<std::shared_ptr<const DrawnImage>(const ImageRequest&, const Progress&)>;

  /// On a device that other threads use as well. `finished` is called by the thread after each image, also where no result comes of it.
  RenderThread(const Device& device, VolumeCache& volumes, std::function<void()> finished);
  /// `make` makes the images, in the thread; what its progress throws is to pass through it.
  RenderThread(Make make, std::function<void()> finished);
  /// Abandons the image that is being made, and waits until the device has completed the slice that it is executing.
  ~RenderThread();
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  /// Replaces a request that has not been started.
  void ask(ImageRequest request);
  /// Abandons the image that is being made, the one that was made and not taken, and the request that waits: no result comes of them.
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

  const Make make_;
  const std::function<void()> finished_;

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
