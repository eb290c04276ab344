#pragma once
// Records, submits and times GPU work. A recording is submitted once, in slices.
//
// A slice is a command buffer with about kSliceMilliseconds of work, estimated from the last time that passes of the same
// names ran. A dispatch that takes longer than a slice is divided into ranges of workgroups; an indirect one is not. submitAndWait()
// submits a slice when the one before it is complete, so that other threads (a window) can use the device in between, and so that work can
// be abandoned soon.

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/stages.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/image.h"
#include "engine/vulkan/pipeline.h"
#include "engine/vulkan/queue.h"
#include "engine/vulkan/texture.h"

namespace freevoxels {

/// The resource of a binding of set 0: a whole buffer, its texels, a storage image in layout GENERAL, or a
/// texture, with its sampler or as a storage image in layout GENERAL.
using Binding = std::variant<const Buffer*, const TexelView*, const RenderTarget*, const Texture*>;

/// Ticks from `first` to `second`, two timestamps of `bits` valid bits that may have wrapped around once in
/// between.
std::uint64_t ticksBetween(std::uint64_t first, std::uint64_t second, std::uint32_t bits);

/// The stage of all compute passes, for barriers.
inline constexpr VkPipelineStageFlags2 kComputeStage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;

/// The device time that a slice is meant to take.
constexpr double kSliceMilliseconds = 40.0;

/// A recording belongs to one thread. beginPass() is no barrier: a pass ends with a barrier that makes its writes visible to
/// the stages that read them.
class Commands {
 public:
  explicit Commands(const Device& device);
  ~Commands();
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  /// The command buffer that is being recorded. Valid until the next call of a member function.
  VkCommandBuffer handle() const { return buffer_; }
  /// The number of slices so far.
  std::size_t slices() const { return slices_; }
  /// Whether no pass has begun.
  bool empty() const { return passes_.empty(); }

  /// Starts a timer under this name, which runs until the next beginPass. The times of passes with the same
  /// name are added. Not to be called within rendering.
  void beginPass(const std::string& name);

  /// Dispatches `threads` invocations in each dimension, rounded up to whole workgroups.
  template <typename Push>
  void dispatch(const Pipeline& pipeline, std::span<const Binding> bindings, const Push& push,
                glm::ivec3 threads) {
    dispatchThreads(pipeline, [&] { bind(pipeline, bindings, &push, sizeof(Push)); }, threads);
  }
  /// Dispatches a pipeline that has no push constants.
  void dispatch(const Pipeline& pipeline, std::span<const Binding> bindings, glm::ivec3 threads) {
    dispatchThreads(pipeline, [&] { bind(pipeline, bindings, nullptr, 0); }, threads);
  }
  /// Dispatches `count` invocations in one dimension, for each of `layers` layers (gl_WorkGroupID.z). A
  /// shader computes its workgroup's index as gl_WorkGroupID.x + y * gl_NumWorkGroups.x, since one dimension
  /// may have too few workgroups.
  template <typename Push>
  void dispatchLinear(const Pipeline& pipeline, std::span<const Binding> bindings, const Push& push,
                      std::uint64_t count, std::uint32_t layers = 1) {
    dispatchInvocations(pipeline, [&] { bind(pipeline, bindings, &push, sizeof(Push)); }, count, layers);
  }
  /// The numbers of workgroups are in `arguments`. If `mostGroups`, the largest number of them, is given, the dispatch is expected to take
  /// that many times what such a workgroup of the pass took last time, and may begin a slice; it is not divided.
  template <typename Push>
  void dispatchIndirect(const Pipeline& pipeline, std::span<const Binding> bindings, const Push& push, const Buffer& arguments,
                        VkDeviceSize offset, std::uint64_t mostGroups = 0) {
    if (mostGroups > 0) {
      makeRoomInSlice(expectedMilliseconds(mostGroups));
      countGroups(mostGroups);
    }
    bind(pipeline, bindings, &push, sizeof(Push));
    // Mesa 22.3's lavapipe would begin at the base workgroup of the last vkCmdDispatchBase.
    vkCmdDispatch(buffer_, 0, 0, 0);
    vkCmdDispatchIndirect(buffer_, arguments.handle(), offset);
  }
  void bind(const Pipeline& pipeline, std::span<const Binding> bindings, const void* push,
            std::size_t pushBytes);
  /// To be called before rendering that draws so many pixels, which is not divided: begins a slice where these are expected not to fit.
  void makeRoomForPixels(std::uint64_t pixels);

  /// Records a write of up to 64 KiB into `buffer`. Later commands see it.
  template <typename Value>
  void update(const Buffer& buffer, const Value& value) {
    static_assert(sizeof(Value) <= 65536 && sizeof(Value) % 4 == 0);
    vkCmdUpdateBuffer(buffer_, buffer.handle(), 0, sizeof(Value), &value);
    barrier(VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  }
  /// Records filling the whole buffer with 0. Later commands see it.
  void clear(const Buffer& buffer) {
    vkCmdFillBuffer(buffer_, buffer.handle(), 0, VK_WHOLE_SIZE, 0);
    barrier(VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  }
  /// Records filling all channels of a target in any layout with `value`, and leaves it in GENERAL. Later commands see it.
  void fill(const RenderTarget& target, float value);
  void copy(const Buffer& from, const Buffer& to, VkBufferCopy region);
  /// Copies a target, which must be in layout GENERAL and visible to the transfer stage, and stays in that
  /// layout.
  void copy(const RenderTarget& from, const Buffer& to);
  /// Copies into a target in any layout, and leaves it in GENERAL, visible to compute shaders.
  void copy(const Buffer& from, const RenderTarget& to);

  /// Makes all writes of the `from` stages visible to the `to` stages. Later writes of `to` wait for reads of `from`.
  void barrier(VkPipelineStageFlags2 from, VkPipelineStageFlags2 to);
  /// As barrier(), for one image, whose layout changes.
  void transition(VkImage image, VkImageLayout from, VkImageLayout to, VkPipelineStageFlags2 fromStage,
                  VkPipelineStageFlags2 toStage);
  void transition(const RenderTarget& target, VkImageLayout from, VkImageLayout to,
                  VkPipelineStageFlags2 fromStage, VkPipelineStageFlags2 toStage) {
    transition(target.handle(), from, to, fromStage, toStage);
  }

  /// Ends the recording, submits it and blocks until it is complete. `progress` is called before each slice if there are
  /// several, and every 50 ms while a slice runs. If it throws, the current slice is completed, the others are abandoned
  /// and the exception is rethrown; the contents of what the recording writes are undefined then. Throws if the device
  /// fails.
  void submitAndWait(const Progress& progress = {});
  /// Device time of each pass in the order of recording. Only valid after submitAndWait.
  std::vector<StageTime> times() const;

 private:
  /// The time between two neighbouring timestamps, and the units of work in it: workgroups, and 1 for each pass.
  struct Span {
    std::string pass;  ///< empty between slices
    double units = 0.0;
  };

  void dispatchThreads(const Pipeline& pipeline, const std::function<void()>& bindAll, glm::ivec3 threads);
  void dispatchInvocations(const Pipeline& pipeline, const std::function<void()>& bindAll, std::uint64_t count,
                           std::uint32_t layers);
  void dispatchGroups(const std::function<void()>& bindAll, glm::uvec3 groups, int axis);
  double expectedMilliseconds(std::uint64_t groups) const;
  void makeRoomInSlice(double milliseconds);
  void countGroups(std::uint64_t groups);
  void beginSlice();
  void endSlice();
  void nextSlice();
  bool mayDivide() const;
  void beginSpan(const std::string& pass);
  void writeTimestamp();
  void waitFor(std::uint64_t submission, const Progress& progress) const;
  void reportProgress(const Progress& progress) const;
  std::vector<double> milliseconds() const;
  void learnCosts() const;

  const Device& device_;
  std::unique_ptr<CommandSlot> slot_;
  VkCommandBuffer buffer_ = VK_NULL_HANDLE;
  std::size_t slices_ = 0;        ///< begun
  double sliceMilliseconds_ = 0;  ///< expected of the current slice
  std::string pass_;              ///< the current one
  std::vector<Span> passes_;      ///< span i is from timestamp i to timestamp i + 1
};

}  // namespace freevoxels
