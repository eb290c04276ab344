#include "engine/gathering/gather_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "embedded/full_screen.h"
#include "embedded/gather_empty.h"
#include "embedded/gather_empty_distance.h"
#include "embedded/gather_pixels.h"
#include "embedded/gather_pixels_distance.h"
#include "embedded/gather_pixels_tiles.h"
#include "embedded/gather_rows.h"
#include "embedded/gather_rows_distance.h"
#include "embedded/gather_rows_tiles.h"
#include "engine/core/error.h"
#include "engine/vulkan/pipeline.h"
#include "engine/vulkan/rendering.h"

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
  constexpr std::array kFormats{kTargetColorFormat, kTargetScalarFormat};
  if (std::min(frame.pixelExtent.x, frame.pixelExtent.y) <= 0) {
    for (const RenderTarget* target : targets.all())
      commands.fill(*target, target == &targets.distance ? std::numeric_limits<float>::infinity() : 0.0f);
    return;
  }
  makeRoom(sizeOfRows(frame), withDistance);
  const std::uint32_t count = withDistance ? 2 : 1, taps = frame.pitch >= 1.0f ? shader::kSparseResampleTaps : shader::kResampleTaps;
  const std::array<const RenderTarget*, 2> rows{&rowColors_, &rowDistances_}, pixels{&targets.colorEnergy, &targets.distance};
  const auto pipeline = [&](const Shader& vertex, const Shader& fragment, const Specialisation& constants) {
    return makeGraphicsPipeline(device_, vertex, fragment, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, std::span(kFormats).first(count),
                                Blend::Replace, constants);
  };
  const Specialisation constants{taps, std::uint32_t(frame.raysOfPixel)};
  const Pipeline empty = pipeline(shaders::full_screen, withDistance ? shaders::gather_empty_distance : shaders::gather_empty, {});
  const Pipeline drawRows =
      pipeline(shaders::gather_rows_tiles, withDistance ? shaders::gather_rows_distance : shaders::gather_rows, constants);
  const Pipeline drawPixels =
      pipeline(shaders::gather_pixels_tiles, withDistance ? shaders::gather_pixels_distance : shaders::gather_pixels, constants);
  const Buffer& list = sums.tiles.list();
  const std::array<Binding, 4> samples{&frameBuffer, &sums.colorEnergy, &sums.distances, &list},
      ofRows{&frameBuffer, rows[0], rows[count - 1], &list};
  // Draws the listed tiles of images of which `used` is used; elsewhere these stay as they are, or are empty.
  const auto draw = [&](const Pipeline& pass, std::span<const Binding> bindings, shader::ResamplePush push,
                        std::span<const RenderTarget* const> images, glm::ivec2 used, bool isFirst) {
    push.target = used;
    const std::array views{images[0]->view(), images[1]->view()};
    beginRendering(commands, std::span(views).first(count), used, isFirst ? VK_ATTACHMENT_LOAD_OP_DONT_CARE : VK_ATTACHMENT_LOAD_OP_LOAD);
    if (isFirst) {
      commands.bind(empty, {}, nullptr, 0);
      vkCmdDraw(commands.handle(), 3, 1, 0, 0);
    }
    commands.bind(pass, bindings, &push, sizeof(push));
    sums.tiles.draw(commands);
    vkCmdEndRendering(commands.handle());
  };
  for (const RenderTarget* target : targets.all())
    commands.transition(*target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, kOutput);
  commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, kFragment);
  const int begin = frame.firstPixel.y, end = frame.firstPixel.y + frame.pixelExtent.y;
  for (int first = begin, next = 0; first < end; first = next) {
    next = std::min(first + pixelsOfBand(frame), end);
    const glm::ivec2 band = rowsOf(frame, first, next);
    FV_CHECK_LE(band.y - band.x, kBandRows);
    const shader::ResamplePush push{.firstRow = band.x, .endRow = band.y, .firstPixel = first, .endPixel = next};
    commands.makeRoomForPixels(std::uint64_t(frame.pixelExtent.x) * std::uint64_t(band.y - band.x + next - first));
    for (std::uint32_t i = 0; i < count; ++i)
      commands.transition(*rows[i], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, kFragment, kOutput);
    draw(drawRows, samples, push, rows, {frame.size.x, band.y - band.x}, true);
    commands.barrier(kOutput, kFragment | kOutput);  // the rows are read, and the pixels of the band before are loaded
    draw(drawPixels, ofRows, push, pixels, frame.size, first == begin);
  }
  commands.barrier(kOutput, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
}

}  // namespace freevoxels
