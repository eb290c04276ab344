#include "apps/common/volumes_ahead.h"

#include <algorithm>

namespace freevoxels {

std::size_t framesOfFirstVolume(std::span<const FrameJob> frames) {
  const auto other = std::ranges::find_if(frames, [&](const FrameJob& frame) { return frame.input != frames.front().input; });
  return std::size_t(other - frames.begin());
}

std::vector<std::string> volumesOf(std::span<const FrameJob> frames) {
  std::vector<std::string> volumes;
  for (; !frames.empty(); frames = frames.subspan(framesOfFirstVolume(frames))) volumes.push_back(frames.front().input);
  return volumes;
}

VolumesAhead::VolumesAhead(std::vector<std::string> inputs, Read read) : inputs_(std::move(inputs)), read_(std::move(read)) {
  readNext();
}

void VolumesAhead::readNext() {
  if (begun_ == inputs_.size()) return;
  pending_ = std::async(std::launch::async, read_, inputs_[begun_]);
  ++begun_;
}

std::shared_ptr<const VolumeSource> VolumesAhead::next() {
  pending_.wait();
  std::future<std::shared_ptr<const VolumeSource>> read = std::move(pending_);
  readNext();
  return read.get();
}

}  // namespace freevoxels
