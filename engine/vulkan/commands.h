#pragma once
// Records, submits and times GPU work: one command buffer that is submitted once.

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/stages.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/image.h"
#include "engine/vulkan/pipeline.h"
#include "engine/vulkan/texture.h"

namespace freevoxels {

/// The resource of a binding of set 0: a whole buffer, its texels, a storage image in layout GENERAL, or a
/// texture with its sampler.
using Binding = std::variant<const Buffer*, const TexelView*, const RenderTarget*, const Texture*>;

/// Ticks from `first` to `second`, two timestamps of `bits` valid bits that may have wrapped around once in
/// between.
std::uint64_t ticksBetween(std::uint64_t first, std::uint64_t second, std::uint32_t bits);

class Commands {
 public:
  explicit Commands(const Device& device);
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  VkCommandBuffer handle() const { return buffer_; }

  /// Starts a timer under this name, which runs until the next beginPass. The times of passes with the same
  /// name are added.
  void beginPass(const std::string& name);

  /// Dispatches `threads` invocations in each dimension, rounded up to whole workgroups.
  template <typename Push>
  void dispatch(const Pipeline& pipeline, std::span<const Binding> bindings, const Push& push,
                glm::ivec3 threads) {
    bind(pipeline, bindings, &push, sizeof(Push));
    dispatchThreads(pipeline, threads);
  }
  /// Dispatches a pipeline that has no push constants.
  void dispatch(const Pipeline& pipeline, std::span<const Binding> bindings, glm::ivec3 threads) {
    bind(pipeline, bindings, nullptr, 0);
    dispatchThreads(pipeline, threads);
  }
  /// Dispatches `count` invocations in one dimension, for each of `layers` layers (gl_WorkGroupID.z). A
  /// shader computes its workgroup's index as gl_WorkGroupID.x + y * gl_NumWorkGroups.x, since one dimension
  /// may have too few workgroups.
  template <typename Push>
  void dispatchLinear(const Pipeline& pipeline, std::span<const Binding> bindings, const Push& push,
                      std::uint64_t count, std::uint32_t layers = 1) {
    bind(pipeline, bindings, &push, sizeof(Push));
    dispatchInvocations(pipeline, count, layers);
  }
  template <typename Push>
  void dispatchIndirect(const Pipeline& pipeline, std::span<const Binding> bindings, const Push& push,
                        const Buffer& arguments, VkDeviceSize offset) {
    bind(pipeline, bindings, &push, sizeof(Push));
    vkCmdDispatchIndirect(buffer_, arguments.handle(), offset);
  }
  void bind(const Pipeline& pipeline, std::span<const Binding> bindings, const void* push,
            std::size_t pushBytes);

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
  void copy(const Buffer& from, const Buffer& to, VkBufferCopy region);
  /// Copies a target, which must be in layout GENERAL and is left in TRANSFER_SRC_OPTIMAL.
  void copy(const RenderTarget& from, const Buffer& to);

  /// Makes all writes of the `from` stages visible to the `to` stages.
  void barrier(VkPipelineStageFlags2 from, VkPipelineStageFlags2 to);
  void transition(VkImage image, VkImageLayout from, VkImageLayout to, VkPipelineStageFlags2 fromStage,
                  VkPipelineStageFlags2 toStage);
  void transition(const RenderTarget& target, VkImageLayout from, VkImageLayout to,
                  VkPipelineStageFlags2 fromStage, VkPipelineStageFlags2 toStage) {
    transition(target.handle(), from, to, fromStage, toStage);
  }

  /// Ends the recording, submits it and blocks until it is complete, while reporting the passes as the device
  /// finishes them. Throws if the device fails. An exception of `progress` is rethrown after the device has
  /// finished, so that no resource is freed while in use.
  void submitAndWait(const Progress& progress = {});
  /// Device time of each pass in the order of recording. Only valid after submitAndWait.
  std::vector<StageTime> times() const;

 private:
  void dispatchThreads(const Pipeline& pipeline, glm::ivec3 threads);
  void dispatchInvocations(const Pipeline& pipeline, std::uint64_t count, std::uint32_t layers);
  void writeTimestamp();
  void reportProgress(const Progress& progress) const;

  const Device& device_;
  OwnedCommandPool pool_;
  OwnedQueryPool queries_;
  OwnedSemaphore timeline_;
  VkCommandBuffer buffer_ = VK_NULL_HANDLE;
  std::vector<std::string> passes_;  ///< pass i runs from timestamp i to timestamp i + 1
};

}  // namespace freevoxels
