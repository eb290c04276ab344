#include "engine/vulkan/target_readback.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <glm/glm.hpp>
#include <span>

namespace freevoxels {

namespace {

constexpr std::size_t kBytesATask = std::size_t(1) << 20;

/// Touches each page of new memory on all processors: the system takes longer to provide the pages than one processor to fill them.
void touchPages(std::byte* memory, std::size_t bytes) {
  constexpr std::size_t kPage = 4096;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bytes, kBytesATask), [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t i = range.begin(); i < range.end(); i += kPage) memory[i] = std::byte(0);
  });
}

}  // namespace

void TargetReadback::record(const Device& device, Commands& commands, const RenderTarget& target) {
  const std::uint64_t bytes = std::uint64_t(target.size().x) * std::uint64_t(target.size().y) * bytesPerPixel(target.format());
  if (buffer_.bytes() != bytes) {
    buffer_ = {};  // not both at once
    buffer_ = Buffer(device, bytes, MemoryUse::Readback, "image on the host");
  }
  commands.copy(target, buffer_);
}

template <typename Pixel>
std::vector<Pixel> TargetReadback::read() const {
  const std::span<const Pixel> pixels(reinterpret_cast<const Pixel*>(buffer_.mapped()), buffer_.bytes() / sizeof(Pixel));
  std::vector<Pixel> copy;
  copy.reserve(pixels.size());
  touchPages(reinterpret_cast<std::byte*>(copy.data()), pixels.size_bytes());
  copy.assign(pixels.begin(), pixels.end());
  return copy;
}

template std::vector<glm::vec4> TargetReadback::read() const;
template std::vector<float> TargetReadback::read() const;

}  // namespace freevoxels
