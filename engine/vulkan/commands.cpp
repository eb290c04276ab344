#include "engine/vulkan/commands.h"

#include <algorithm>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr std::uint32_t kMaximumTimestamps = 4096;
constexpr std::uint64_t kProgressInterval = 50'000'000;  // nanoseconds between two queries of the progress

constexpr VkAccessFlags2 kAnyAccess = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

}  // namespace

std::uint64_t ticksBetween(std::uint64_t first, std::uint64_t second, std::uint32_t bits) {
  return (second - first) & (~std::uint64_t(0) >> (64 - bits));
}

Commands::Commands(const Device& device) : device_(device) {
  const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                         .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                         .queueFamilyIndex = device.queueFamily()};
  VkCommandPool pool = VK_NULL_HANDLE;
  VK_CHECK(vkCreateCommandPool(device.handle(), &poolInfo, nullptr, &pool));
  pool_ = OwnedCommandPool(device.handle(), pool);

  const VkQueryPoolCreateInfo queryInfo{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = kMaximumTimestamps};
  VkQueryPool queries = VK_NULL_HANDLE;
  VK_CHECK(vkCreateQueryPool(device.handle(), &queryInfo, nullptr, &queries));
  queries_ = OwnedQueryPool(device.handle(), queries);
  vkResetQueryPool(device.handle(), queries, 0, kMaximumTimestamps);

  const VkSemaphoreTypeCreateInfo typeInfo{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                           .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
  const VkSemaphoreCreateInfo semaphoreInfo{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO,
                                            .pNext = &typeInfo};
  VkSemaphore semaphore = VK_NULL_HANDLE;
  VK_CHECK(vkCreateSemaphore(device.handle(), &semaphoreInfo, nullptr, &semaphore));
  timeline_ = OwnedSemaphore(device.handle(), semaphore);

  const VkCommandBufferAllocateInfo bufferInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = pool,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
  VK_CHECK(vkAllocateCommandBuffers(device.handle(), &bufferInfo, &buffer_));
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  VK_CHECK(vkBeginCommandBuffer(buffer_, &begin));
}

void Commands::writeTimestamp() {
  vkCmdWriteTimestamp2(buffer_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(),
                       std::uint32_t(passes_.size()));
}

void Commands::beginPass(const std::string& name) {
  FV_CHECK_LT(passes_.size() + 1, std::size_t(kMaximumTimestamps));
  writeTimestamp();
  // Lavapipe writes the timestamp when it reaches a barrier, which without this one may be after work that
  // was recorded later.
  barrier(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  passes_.push_back(name);
}

void Commands::bind(const Pipeline& pipeline, std::span<const Binding> bindings, const void* push,
                    std::size_t pushBytes) {
  FV_CHECK_EQ(bindings.size(), pipeline.interface().bindings.size());
  FV_CHECK_EQ(pushBytes, std::size_t(pipeline.interface().pushConstantBytes));
  std::vector<VkDescriptorBufferInfo> buffers(bindings.size());
  std::vector<VkDescriptorImageInfo> images(bindings.size());
  std::vector<VkBufferView> views(bindings.size());
  std::vector<VkWriteDescriptorSet> writes;
  for (std::uint32_t i = 0; i < bindings.size(); ++i) {
    VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                               .dstBinding = i,
                               .descriptorCount = 1,
                               .descriptorType = pipeline.interface().bindings[i]};
    if (const auto* buffer = std::get_if<const Buffer*>(&bindings[i])) {
      buffers[i] = {.buffer = (*buffer)->handle(), .offset = 0, .range = VK_WHOLE_SIZE};
      write.pBufferInfo = &buffers[i];
    } else if (const auto* view = std::get_if<const TexelView*>(&bindings[i])) {
      views[i] = (*view)->handle();
      write.pTexelBufferView = &views[i];
    } else if (const auto* texture = std::get_if<const Texture*>(&bindings[i])) {
      images[i] = {.sampler = (*texture)->sampler(),
                   .imageView = (*texture)->view(),
                   .imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
      write.pImageInfo = &images[i];
    } else {
      images[i] = {.imageView = std::get<const RenderTarget*>(bindings[i])->view(),
                   .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
      write.pImageInfo = &images[i];
    }
    writes.push_back(write);
  }
  vkCmdBindPipeline(buffer_, pipeline.bindPoint(), pipeline.handle());
  vkCmdPushDescriptorSetKHR(buffer_, pipeline.bindPoint(), pipeline.layout(), 0, std::uint32_t(writes.size()),
                            writes.data());
  if (pushBytes > 0)
    vkCmdPushConstants(buffer_, pipeline.layout(), pipeline.stages(), 0, std::uint32_t(pushBytes), push);
}

void Commands::dispatchThreads(const Pipeline& pipeline, glm::ivec3 threads) {
  const glm::ivec3 groups = (threads + pipeline.workgroup() - 1) / pipeline.workgroup();
  for (int axis = 0; axis < 3; ++axis)
    FV_CHECK_LE(std::uint32_t(groups[axis]), device_.limits().maxComputeWorkGroupCount[axis]);
  vkCmdDispatch(buffer_, std::uint32_t(groups.x), std::uint32_t(groups.y), std::uint32_t(groups.z));
}

void Commands::dispatchInvocations(const Pipeline& pipeline, std::uint64_t count, std::uint32_t layers) {
  constexpr std::uint64_t kRow = 65535;  // workgroups that every device supports in one dimension
  const auto threads = std::uint64_t(pipeline.workgroup().x);
  const std::uint64_t groups = (count + threads - 1) / threads;
  const std::uint64_t rows = (groups + kRow - 1) / kRow;
  FV_CHECK_LE(rows, kRow);
  vkCmdDispatch(buffer_, std::uint32_t(std::min(groups, kRow)), std::uint32_t(rows), layers);
}

void Commands::copy(const Buffer& from, const Buffer& to, VkBufferCopy region) {
  vkCmdCopyBuffer(buffer_, from.handle(), to.handle(), 1, &region);
  barrier(VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
}

void Commands::copy(const RenderTarget& from, const Buffer& to) {
  const VkBufferImageCopy region{
      .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
      .imageExtent = {std::uint32_t(from.size().x), std::uint32_t(from.size().y), 1}};
  transition(from, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
             VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_TRANSFER_BIT);
  vkCmdCopyImageToBuffer(buffer_, from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(), 1,
                         &region);
}

void Commands::barrier(VkPipelineStageFlags2 from, VkPipelineStageFlags2 to) {
  const VkMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                .srcStageMask = from,
                                .srcAccessMask = kAnyAccess,
                                .dstStageMask = to,
                                .dstAccessMask = kAnyAccess};
  const VkDependencyInfo dependency{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &memory};
  vkCmdPipelineBarrier2(buffer_, &dependency);
}

void Commands::transition(VkImage image, VkImageLayout from, VkImageLayout to,
                          VkPipelineStageFlags2 fromStage, VkPipelineStageFlags2 toStage) {
  const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                      .srcStageMask = fromStage,
                                      .srcAccessMask = kAnyAccess,
                                      .dstStageMask = toStage,
                                      .dstAccessMask = kAnyAccess,
                                      .oldLayout = from,
                                      .newLayout = to,
                                      .image = image,
                                      .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .imageMemoryBarrierCount = 1,
                                    .pImageMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(buffer_, &dependency);
}

void Commands::submitAndWait(const Progress& progress) {
  writeTimestamp();
  // Makes the device's writes visible to the host, which may have the memory mapped, and to later
  // submissions.
  barrier(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
          VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT);
  VK_CHECK(vkEndCommandBuffer(buffer_));
  const VkCommandBufferSubmitInfo command{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                          .commandBuffer = buffer_};
  const VkSemaphoreSubmitInfo signal{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                     .semaphore = timeline_.get(),
                                     .value = 1,
                                     .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
  const VkSubmitInfo2 submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             .commandBufferInfoCount = 1,
                             .pCommandBufferInfos = &command,
                             .signalSemaphoreInfoCount = 1,
                             .pSignalSemaphoreInfos = &signal};
  VK_CHECK(vkQueueSubmit2(device_.queue(), 1, &submit, VK_NULL_HANDLE));

  const VkSemaphore semaphore = timeline_.get();
  const std::uint64_t done = 1;
  const VkSemaphoreWaitInfo wait{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                 .semaphoreCount = 1,
                                 .pSemaphores = &semaphore,
                                 .pValues = &done};
  for (;;) {
    const VkResult result =
        vkWaitSemaphores(device_.handle(), &wait, progress ? kProgressInterval : UINT64_MAX);
    if (result == VK_SUCCESS) return;
    if (result != VK_TIMEOUT) VK_CHECK_RESULT(result, "vkWaitSemaphores");
    try {
      reportProgress(progress);
    } catch (...) {  // wait before unwinding, so that no resource is freed while in use
      VK_CHECK(vkWaitSemaphores(device_.handle(), &wait, UINT64_MAX));
      throw;
    }
  }
}

void Commands::reportProgress(const Progress& progress) const {
  if (passes_.empty()) return;
  struct Timestamp {
    std::uint64_t value, available;
  };
  std::vector<Timestamp> stamps(passes_.size() + 1);
  const VkResult result = vkGetQueryPoolResults(
      device_.handle(), queries_.get(), 0, std::uint32_t(stamps.size()), stamps.size() * sizeof(Timestamp),
      stamps.data(), sizeof(Timestamp), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
  if (result != VK_NOT_READY) VK_CHECK_RESULT(result, "vkGetQueryPoolResults");
  const auto started =
      std::ranges::count_if(stamps, [](const Timestamp& stamp) { return stamp.available != 0; });
  if (started == 0) return;
  const std::size_t current = std::min(std::size_t(started) - 1, passes_.size() - 1);
  progress(passes_[current], double(current) / double(passes_.size()));
}

std::vector<StageTime> Commands::times() const {
  std::vector<std::uint64_t> stamps(passes_.size() + 1);
  VK_CHECK(vkGetQueryPoolResults(device_.handle(), queries_.get(), 0, std::uint32_t(stamps.size()),
                                 stamps.size() * sizeof(std::uint64_t), stamps.data(), sizeof(std::uint64_t),
                                 VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
  std::vector<StageTime> times;
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    const std::uint64_t ticks = ticksBetween(stamps[i], stamps[i + 1], device_.timestampBits());
    const double milliseconds = double(ticks) * double(device_.limits().timestampPeriod) * 1e-6;
    const auto same = std::ranges::find(times, passes_[i], &StageTime::name);
    if (same != times.end())
      same->milliseconds += milliseconds;
    else
      times.push_back({passes_[i], milliseconds, true});
  }
  return times;
}

}  // namespace freevoxels
