#pragma once
// Draws Dear ImGui's triangles into a window.

#include <imgui.h>

#include <functional>

#include "apps/view/swapchain.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/pipeline.h"
#include "engine/vulkan/texture.h"

namespace freevoxels {

/// Dear ImGui's handle of a texture, which must live until the frame that shows it is drawn.
inline ImTextureID textureId(const Texture& texture) {
  return const_cast<Texture*>(&texture);
}

class UiPainter {
 public:
  /// To be called after Dear ImGui has its fonts.
  UiPainter(const Device& device, VkFormat format);

  /// Clears the acquired image and draws into it, up to layout PRESENT_SRC_KHR, after the commands that
  /// `recordTextures` records. Blocks until it is complete.
  void draw(const ImDrawData& triangles, const Swapchain& target,
            const std::function<void(Commands&)>& recordTextures);

 private:
  void upload(const ImDrawData& triangles);
  void record(Commands& commands, const ImDrawData& triangles, glm::ivec2 size) const;

  const Device& device_;
  Pipeline pipeline_;
  Texture fonts_;
  Buffer vertices_, indices_;  ///< at least as large as for the last frame
};

}  // namespace freevoxels
