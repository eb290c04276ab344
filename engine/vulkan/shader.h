#pragma once
// A compiled shader and its interface, which shaders/reflect.py reads from the SPIR-V at build time (embedded/NAME.h).

#include <volk.h>

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace freevoxels {

struct Shader {
  std::span<const std::uint32_t> words;  ///< SPIR-V
  const char* name = "";                 ///< name of the shader's file, for debuggers
  /// The type of each binding of set 0, or kNoBinding if only another stage of the pipeline has it.
  std::span<const VkDescriptorType> bindings;
  std::uint32_t pushConstantBytes = 0;
  glm::ivec3 workgroup{1};  ///< invocations of a workgroup; compute only
};

inline constexpr VkDescriptorType kNoBinding = VK_DESCRIPTOR_TYPE_MAX_ENUM;

}  // namespace freevoxels
