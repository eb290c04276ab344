#include "apps/view/ui_painter.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "embedded/ui_fragment.h"
#include "embedded/ui_vertex.h"
#include "engine/core/error.h"
#include "engine/vulkan/rendering.h"
#include "shaders/ui_interface.h"

namespace freevoxels {

namespace {

static_assert(sizeof(shader::UiVertex) == sizeof(ImDrawVert));
static_assert(sizeof(ImDrawIdx) == 2);

Pipeline makePipeline(const Device& device, VkFormat format) {
  return makeGraphicsPipeline(
      device, shaders::ui_vertex, shaders::ui_fragment,
      VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, std::array{format}, Blend::Over);
}

Texture makeFonts(const Device& device) {
  unsigned char* texels = nullptr;
  glm::ivec2 size(0);
  ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&texels, &size.x, &size.y);
  Texture fonts(device, size, "fonts");
  fonts.upload(device, {texels, std::size_t(size.x) * std::size_t(size.y) * 4});
  return fonts;
}

/// Doubled until it is enough, so that few frames make one.
void makeRoom(const Device& device, Buffer& buffer, std::uint64_t bytes, const char* name,
              VkBufferUsageFlags usage) {
  if (buffer.bytes() >= bytes && buffer.bytes() > 0) return;
  constexpr std::uint64_t kMin = 1 << 16;
  buffer = {};
  buffer = Buffer(device, std::max(2 * bytes, kMin), MemoryUse::Upload, name, usage);
}

/// A clip rectangle in pixels of the image.
VkRect2D scissorOf(const ImVec4& clip, const ImDrawData& triangles, glm::ivec2 size) {
  const glm::vec2 origin(triangles.DisplayPos.x, triangles.DisplayPos.y);
  const glm::vec2 scale(triangles.FramebufferScale.x, triangles.FramebufferScale.y);
  const glm::ivec2 low =
      glm::clamp(glm::ivec2((glm::vec2(clip.x, clip.y) - origin) * scale), glm::ivec2(0), size);
  const glm::ivec2 high = glm::clamp(glm::ivec2((glm::vec2(clip.z, clip.w) - origin) * scale), low, size);
  return {{low.x, low.y}, {std::uint32_t(high.x - low.x), std::uint32_t(high.y - low.y)}};
}

}  // namespace

UiPainter::UiPainter(const Device& device, VkFormat format)
    : device_(device), pipeline_(makePipeline(device, format)), fonts_(makeFonts(device)) {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->SetTexID(textureId(fonts_));
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
}

void UiPainter::upload(const ImDrawData& triangles) {
  makeRoom(device_, vertices_, std::uint64_t(triangles.TotalVtxCount) * sizeof(ImDrawVert), "ui vertices", 0);
  makeRoom(device_, indices_, std::uint64_t(triangles.TotalIdxCount) * sizeof(ImDrawIdx), "ui indices",
           VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  std::byte* vertex = vertices_.mapped();
  std::byte* index = indices_.mapped();
  for (int i = 0; i < triangles.CmdListsCount; ++i) {
    const ImDrawList& list = *triangles.CmdLists[i];
    std::memcpy(vertex, list.VtxBuffer.Data, std::size_t(list.VtxBuffer.size_in_bytes()));
    std::memcpy(index, list.IdxBuffer.Data, std::size_t(list.IdxBuffer.size_in_bytes()));
    vertex += list.VtxBuffer.size_in_bytes();
    index += list.IdxBuffer.size_in_bytes();
  }
}

void UiPainter::record(Commands& commands, const ImDrawData& triangles, glm::ivec2 size) const {
  const VkViewport viewport{0.0f, 0.0f, float(size.x), float(size.y), 0.0f, 1.0f};
  vkCmdSetViewport(commands.handle(), 0, 1, &viewport);
  const glm::vec2 display(triangles.DisplaySize.x, triangles.DisplaySize.y);
  const glm::vec2 origin(triangles.DisplayPos.x, triangles.DisplayPos.y);
  const shader::UiPush push{.scale = 2.0f / display, .offset = -1.0f - 2.0f * origin / display};
  vkCmdBindIndexBuffer(commands.handle(), indices_.handle(), 0, VK_INDEX_TYPE_UINT16);
  ImTextureID bound = nullptr;
  int firstVertex = 0, firstIndex = 0;
  for (int i = 0; i < triangles.CmdListsCount; ++i) {
    const ImDrawList& list = *triangles.CmdLists[i];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      FV_CHECK_EQ(command.UserCallback == nullptr, true);
      const VkRect2D scissor = scissorOf(command.ClipRect, triangles, size);
      if (scissor.extent.width == 0 || scissor.extent.height == 0) continue;
      if (command.GetTexID() != bound) {
        bound = command.GetTexID();
        const std::array<Binding, 2> bindings{&vertices_, static_cast<const Texture*>(bound)};
        commands.bind(pipeline_, bindings, &push, sizeof(push));
      }
      vkCmdSetScissor(commands.handle(), 0, 1, &scissor);
      vkCmdDrawIndexed(commands.handle(), command.ElemCount, 1, std::uint32_t(firstIndex) + command.IdxOffset,
                       firstVertex + int(command.VtxOffset), 0);
    }
    firstVertex += list.VtxBuffer.Size;
    firstIndex += list.IdxBuffer.Size;
  }
}

void UiPainter::draw(const ImDrawData& triangles, const Swapchain& target,
                     const std::function<void(Commands&)>& recordTextures) {
  upload(triangles);
  constexpr VkPipelineStageFlags2 kAll = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  constexpr VkPipelineStageFlags2 kOutput = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  Commands commands(device_);
  recordTextures(commands);
  commands.beginPass("user interface");
  commands.transition(target.image(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kAll, kOutput);
  const glm::ivec2 size = target.size();
  const VkImageView view = target.view();
  beginRendering(commands, std::span(&view, 1), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR,
                 {{0, 0}, {std::uint32_t(size.x), std::uint32_t(size.y)}});
  record(commands, triangles, size);
  vkCmdEndRendering(commands.handle());
  commands.transition(target.image(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                      VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, kOutput, kAll);
  commands.submitAndWait();
}

}  // namespace freevoxels
