#include "engine/gathering/gather_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "embedded/gather_pixels.h"
#include "embedded/gather_pixels_distance.h"
#include "embedded/gather_rows.h"
#include "embedded/gather_rows_distance.h"
#include "engine/core/error.h"
#include "engine/vulkan/rectangle.h"

namespace freevoxels {

namespace {

constexpr VkPipelineStageFlags2 kFragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr VkPipelineStageFlags2 kOutput = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;

/// The most rows of the lattice that are drawn along x at a time: they stay in a processor's cache, and no image is higher than devices allow.
constexpr int kBandRows = 512;

/// The first and the end of the rows of the lattice that the pixels `first` to `end` - 1 may read, of those that are stored: at least one,
/// as pixels beyond these read the row at the border.
glm::ivec2 rowsOf(const shader::GatherFrame& frame, int first, int end) {
  constexpr int kMargin = 3;
  const double pitch = double(frame.pitch);
  const int low = int(std::floor(first / pitch)) - kMargin, high = int(std::ceil(end / pitch)) + shader::kResampleTaps + kMargin;
  const int endStored = frame.firstSeen.y + frame.seenExtent.y, begin = std::clamp(low, frame.firstSeen.y, endStored - 1);
  return {begin, std::clamp(high, begin + 1, endStored)};
}

glm::ivec2 sizeOfRows(const shader::GatherFrame& frame) {
  return {frame.size.x, std::min(kBandRows, frame.samples.y)};
}

/// How many rows of pixels need at most kBandRows rows of the lattice.
int pixelsOfBand(const shader::GatherFrame& frame) {
  constexpr int kMostBeside = 16;  // rows
  return std::max(int(double(kBandRows - kMostBeside) * double(frame.pitch)), 1);
}

}  // namespace

std::uint64_t GatherImage::rowBytes(const shader::GatherFrame& frame) {
  const glm::ivec2 size = sizeOfRows(frame);
  return std::uint64_t(size.x) * std::uint64_t(size.y) * (bytesPerPixel(kTargetColorFormat) + bytesPerPixel(kTargetScalarFormat));
}

void GatherImage::makeRoom(glm::ivec2 size, bool withDistance) {
  const auto suffices = [&](const RenderTarget& image) { return image.exists() && glm::max(image.size(), size) == image.size(); };
  if (!suffices(rowColors_)) {
    rowColors_ = {};  // free the old image before allocating the new one
    rowDistances_ = {};
    rowColors_ = RenderTarget(device_, size, kTargetColorFormat, "rows of C and E");
  }
  if (withDistance && !suffices(rowDistances_)) {
    rowDistances_ = {};
    rowDistances_ = RenderTarget(device_, size, kTargetScalarFormat, "rows of distances");
  }
}

void GatherImage::record(Commands& commands, const Buffer& frameBuffer, const shader::GatherFrame& frame, const Sums& sums,
                         const FrameTargets& targets) {
  const bool withDistance = targets.distance.exists();
  if (frame.pixelExtent.x <= 0 || frame.pixelExtent.y <= 0 || frame.seenExtent.y <= 0) return;
  makeRoom(sizeOfRows(frame), withDistance);
  const std::uint32_t count = withDistance ? 2 : 1, taps = frame.pitch >= 1.0f ? shader::kSparseResampleTaps : shader::kResampleTaps;
  const std::array<const RenderTarget*, 2> rows{&rowColors_, &rowDistances_}, pixels{&targets.colorEnergy, &targets.distance};
  constexpr std::array kFormats{kTargetColorFormat, kTargetScalarFormat};
  const auto pipeline = [&](const Shader& shader) {
    return makeRectanglePipeline(device_, shader, std::span(kFormats).first(count), {taps, std::uint32_t(frame.raysOfPixel)});
  };
  const Pipeline drawRows = pipeline(withDistance ? shaders::gather_rows_distance : shaders::gather_rows);
  const Pipeline drawPixels = pipeline(withDistance ? shaders::gather_pixels_distance : shaders::gather_pixels);
  const std::array<Binding, 3> samples{&frameBuffer, &sums.colorEnergy, &sums.distances}, ofRows{&frameBuffer, rows[0], rows[count - 1]};
  const auto draw = [&](const Pipeline& pass, std::span<const Binding> bindings, const shader::ResamplePush& push,
                        std::span<const RenderTarget* const> images, glm::ivec2 first, glm::ivec2 extent) {
    const std::array views{images[0]->view(), images[1]->view()};
    drawRectangle(commands, pass, bindings, &push, sizeof(push), std::span(views).first(count), first, extent);
  };
  commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, kFragment);
  for (int first = frame.firstPixel.y, end = frame.firstPixel.y + frame.pixelExtent.y, next = 0; first < end; first = next) {
    next = std::min(first + pixelsOfBand(frame), end);
    const glm::ivec2 band = rowsOf(frame, first, next);
    FV_CHECK_LE(band.y - band.x, kBandRows);
    const shader::ResamplePush push{.firstRow = band.x};
    commands.makeRoomForPixels(std::uint64_t(frame.pixelExtent.x) * std::uint64_t(band.y - band.x + next - first));
    for (std::uint32_t i = 0; i < count; ++i)
      commands.transition(*rows[i], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, kFragment, kOutput);
    draw(drawRows, samples, push, rows, {frame.firstPixel.x, 0}, {frame.pixelExtent.x, band.y - band.x});
    commands.barrier(kOutput, kFragment);
    draw(drawPixels, ofRows, push, pixels, {frame.firstPixel.x, first}, {frame.pixelExtent.x, next - first});
  }
  commands.barrier(kOutput, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
}

}  // namespace freevoxels
