#pragma once
// Compute and graphics pipelines over embedded SPIR-V, with push descriptors and push constants.

#include <cstdint>
#include <glm/glm.hpp>
#include <initializer_list>
#include <span>
#include <vector>

#include "engine/vulkan/device.h"
#include "engine/vulkan/owned.h"

namespace freevoxels {

/// Embedded SPIR-V and the name that debuggers show.
struct ShaderCode {
  std::span<const std::uint32_t> words;
  const char* name = "";
};

/// What a pipeline's set 0 holds: binding i is of type bindings[i]; and the bytes of its push constants.
struct PipelineInterface {
  std::vector<VkDescriptorType> bindings;
  std::uint32_t pushConstantBytes = 0;
};

/// Values of the specialisation constants 0, 1, 2, ...: ints or bools.
using Specialisation = std::vector<std::uint32_t>;

/// What a fragment does to an attachment.
enum class Blend {
  Additive,  ///< source + destination
  Over,      ///< source + (1 - alpha of the fragment's output for this attachment) * destination
};

class Pipeline {
 public:
  Pipeline() = default;
  VkPipeline handle() const { return pipeline_.get(); }
  VkPipelineLayout layout() const { return layout_.get(); }
  VkPipelineBindPoint bindPoint() const { return bindPoint_; }
  /// That see the descriptors and the push constants.
  VkShaderStageFlags stages() const;
  const PipelineInterface& interface() const { return interface_; }
  /// Invocations of one workgroup; compute only.
  glm::ivec3 workgroup() const { return workgroup_; }

 private:
  friend Pipeline makeComputePipeline(const Device&, const ShaderCode&, PipelineInterface, glm::ivec3,
                                      const Specialisation&);
  friend Pipeline makeGraphicsPipeline(const Device&, const ShaderCode&, const ShaderCode&, PipelineInterface,
                                       VkPrimitiveTopology, std::span<const VkFormat>, Blend,
                                       const Specialisation&);
  Pipeline(const Device& device, PipelineInterface interface, VkPipelineBindPoint bindPoint);

  PipelineInterface interface_;
  VkPipelineBindPoint bindPoint_ = VK_PIPELINE_BIND_POINT_COMPUTE;
  OwnedSetLayout setLayout_;
  OwnedPipelineLayout layout_;
  OwnedPipeline pipeline_;
  glm::ivec3 workgroup_{1};
};

/// `workgroup` must be the shader's local size.
Pipeline makeComputePipeline(const Device& device, const ShaderCode& code, PipelineInterface interface,
                             glm::ivec3 workgroup, const Specialisation& constants = {});

/// No vertex input (vertices are pulled), no depth, no culling; all attachments are blended alike. Viewport
/// and scissor are dynamic.
Pipeline makeGraphicsPipeline(const Device& device, const ShaderCode& vertex, const ShaderCode& fragment,
                              PipelineInterface interface, VkPrimitiveTopology topology,
                              std::span<const VkFormat> attachments, Blend blend,
                              const Specialisation& constants = {});

}  // namespace freevoxels
