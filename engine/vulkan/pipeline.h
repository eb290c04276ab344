#pragma once
// Compute and graphics pipelines over embedded SPIR-V, with push descriptors and push constants.

#include <array>
#include <compare>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "engine/core/stages.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/owned.h"

namespace freevoxels {

/// Embedded SPIR-V and the name that debuggers show.
struct ShaderCode {
  std::span<const std::uint32_t> words;
  const char* name = "";
};

/// The resources of a pipeline: binding i of set 0 has the type bindings[i]; the size of its push constants.
struct PipelineInterface {
  std::vector<VkDescriptorType> bindings;
  std::uint32_t pushConstantBytes = 0;
  auto operator<=>(const PipelineInterface&) const = default;
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

/// Everything that distinguishes pipelines. The workgroup size is part of the code.
struct PipelineKey {
  std::array<const std::uint32_t*, 2> code{};  ///< compute, or vertex and fragment
  PipelineInterface interface;
  Specialisation constants;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  std::vector<VkFormat> attachments;
  Blend blend = Blend::Additive;
  auto operator<=>(const PipelineKey&) const = default;
};

/// The pipelines of a device, kept for reuse: lavapipe takes up to a tenth of a second to compile one.
struct PipelineStore {
  std::mutex mutex;
  std::map<PipelineKey, PipelineParts> made;
  std::vector<StageTime> times;  ///< time to create the pipelines
};

/// Returns a compute pipeline. `workgroup` must equal the shader's local size.
Pipeline makeComputePipeline(const Device& device, const ShaderCode& code, PipelineInterface interface,
                             glm::ivec3 workgroup, const Specialisation& constants = {});

/// Returns a graphics pipeline without vertex input (shaders fetch vertices from buffers), depth test or face
/// culling. All attachments use the same blending. Viewport and scissor are dynamic.
Pipeline makeGraphicsPipeline(const Device& device, const ShaderCode& vertex, const ShaderCode& fragment,
                              PipelineInterface interface, VkPrimitiveTopology topology,
                              std::span<const VkFormat> attachments, Blend blend,
                              const Specialisation& constants = {});

}  // namespace freevoxels
