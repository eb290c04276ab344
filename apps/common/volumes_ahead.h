#pragma once
// The volumes of a command's frames, read in time.

#include <functional>
#include <future>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "apps/common/render_options.h"

namespace freevoxels {

/// How many frames at the beginning are of one volume.
std::size_t framesOfFirstVolume(std::span<const FrameJob> frames);
/// The volumes of the frames in their order, neighbours that are equal once.
std::vector<std::string> volumesOf(std::span<const FrameJob> frames);

/// Reads the volumes of frames in their order, each one while the one before it is drawn: two of them are in memory.
class VolumesAhead {
 public:
  using Read = std::function<std::shared_ptr<const VolumeSource>(const std::string& input)>;
  /// `read` reads a volume, in a thread of its own.
  VolumesAhead(std::vector<std::string> inputs, Read read);

  /// The next volume. Throws what reading it threw, and can be called again for the one after it.
  std::shared_ptr<const VolumeSource> next();

 private:
  void readNext();

  const std::vector<std::string> inputs_;
  const Read read_;
  std::size_t begun_ = 0;  ///< how many volumes are read or being read
  std::future<std::shared_ptr<const VolumeSource>> pending_;
};

}  // namespace freevoxels
