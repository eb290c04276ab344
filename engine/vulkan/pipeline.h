#pragma once
// Compute and graphics pipelines over embedded SPIR-V, with push descriptors and push constants.

#include <array>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "engine/core/stages.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/owned.h"
#include "engine/vulkan/pipeline_cache.h"
#include "engine/vulkan/shader.h"

namespace freevoxels {

/// The bindings of set 0, by number, and the bytes of the push constants: those of all stages.
struct PipelineInterface {
  std::vector<VkDescriptorType> bindings;
  std::uint32_t pushConstantBytes = 0;
};

/// Values of the specialisation constants 0, 1, 2, ...: ints or bools.
using Specialisation = std::vector<std::uint32_t>;

/// How a fragment is blended into an attachment.
enum class Blend {
  Additive,  ///< source + destination
  Over,      ///< source + (1 - alpha of the fragment's output for this attachment) * destination
};

/// The objects of a pipeline, owned by the device.
struct PipelineParts {
  PipelineInterface interface;
  VkPipelineBindPoint bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
  glm::ivec3 workgroup{1};  ///< compute only
  OwnedSetLayout setLayout;
  OwnedPipelineLayout layout;
  OwnedPipeline pipeline;
};

/// A reference to a pipeline of a device, valid as long as the device.
class Pipeline {
 public:
  Pipeline() = default;
  explicit Pipeline(const PipelineParts& parts) : parts_(&parts) {}

  /// VK_NULL_HANDLE for a default-constructed pipeline.
  VkPipeline handle() const { return parts_ != nullptr ? parts_->pipeline.get() : VK_NULL_HANDLE; }
  VkPipelineLayout layout() const { return parts_->layout.get(); }
  VkPipelineBindPoint bindPoint() const { return parts_->bindPoint; }
  /// The stages that access the descriptors and the push constants.
  VkShaderStageFlags stages() const;
  const PipelineInterface& interface() const { return parts_->interface; }
  /// Invocations of one workgroup; compute only.
  glm::ivec3 workgroup() const { return parts_->workgroup; }

 private:
  const PipelineParts* parts_ = nullptr;
};

/// Everything that distinguishes pipelines. The interface is part of the code.
struct PipelineKey {
  std::array<const std::uint32_t*, 2> code{};  ///< compute, or vertex and fragment
  Specialisation constants;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  std::vector<VkFormat> attachments;
  Blend blend = Blend::Additive;
  auto operator<=>(const PipelineKey&) const = default;
};

/// The pipelines of a device, kept for reuse: lavapipe takes up to a tenth of a second to compile one. Any thread may call
/// the member functions; different pipelines can be made at the same time.
class PipelineStore {
 public:
  /// `cacheFile` is the file of PipelineCache.
  PipelineStore(VkDevice device, const std::filesystem::path& cacheFile) : cache_(device, cacheFile) {}

  /// Returns the pipeline for `key`, calling `make` first if there is none.
  Pipeline get(const PipelineKey& key, const std::function<PipelineParts()>& make);
  PipelineCache& cache() { return cache_; }
  /// Time to create the pipelines, summed over all threads.
  std::vector<StageTime> times() const;

 private:
  struct Entry {
    std::once_flag made;
    PipelineParts parts;
  };
  PipelineCache cache_;
  mutable std::mutex mutex_;  ///< of what follows
  std::map<PipelineKey, Entry> entries_;
  std::vector<StageTime> times_;
};

Pipeline makeComputePipeline(const Device& device, const Shader& shader, const Specialisation& constants = {});

/// Returns a graphics pipeline without vertex input (shaders fetch vertices from buffers), depth test or face
/// culling. All attachments use the same blending. Viewport and scissor are dynamic.
Pipeline makeGraphicsPipeline(const Device& device, const Shader& vertex, const Shader& fragment, VkPrimitiveTopology topology,
                              std::span<const VkFormat> attachments, Blend blend, const Specialisation& constants = {});

}  // namespace freevoxels
