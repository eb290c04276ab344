// The library's devices: what a function that logs validation may not do.

#include "apps/common/device_context.h"

#include <gtest/gtest.h>

#include "apps/common/scene_renderer.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

/// Makes the validation layers say something.
void makeAMistake(const DeviceContext& context) {
  const VkBufferCreateInfo empty{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  VkBuffer buffer = VK_NULL_HANDLE;
  if (vkCreateBuffer(context.device->handle(), &empty, nullptr, &buffer) == VK_SUCCESS)
    vkDestroyBuffer(context.device->handle(), buffer, nullptr);
}

TEST(DeviceContext, NothingIsDrawnOrOpenedInTheMiddleOfACallOfVulkan) {
  std::shared_ptr<DeviceContext> context;
  std::unique_ptr<SceneRenderer> renderer;
  int messages = 0;
  const auto log = [&](std::string_view) {
    if (messages++ > 0) return;
    const auto refused = [](const std::function<void()>& work) {
      test::expectRefusal(work, ErrorKind::Usage, {"in a function that logs Vulkan's validation"});
    };
    refused([&] { renderer->render(*renderer->read(nlohmann::json::object()), {}, {}); });
    refused([&] { DeviceContext another(DeviceOptions(), nullptr); });
    refused([&] { sharedContext(DeviceOptions()); });
    EXPECT_TRUE(renderer->timings().empty());
  };
  context = std::make_shared<DeviceContext>(DeviceOptions(), log);
  renderer = std::make_unique<SceneRenderer>(openVolume("procedural:cloud", {{"resolution", 8}}, context), nlohmann::json{{"size", 8}}, context);
  makeAMistake(*context);
  EXPECT_GT(messages, 0);
  EXPECT_THROW(context->checkValidation(), InternalError);
}

}  // namespace
}  // namespace freevoxels
