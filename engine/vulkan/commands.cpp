#include "engine/vulkan/commands.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr std::uint64_t kProgressInterval = 50'000'000;  // nanoseconds between two queries of the progress

/// Milliseconds per workgroup that are assumed for a pass that has not been measured.
constexpr double kUnknownCpuCost = 0.05, kUnknownGpuCost = 0.001;

constexpr VkPipelineStageFlags2 kAnyStage =
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT;

VkAccessFlags2 writesOf(VkPipelineStageFlags2 stages) {
  VkAccessFlags2 access = 0;
  if (stages & kAnyStage) access |= VK_ACCESS_2_MEMORY_WRITE_BIT;
  if (stages & VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT) access |= VK_ACCESS_2_SHADER_WRITE_BIT;
  if (stages & VK_PIPELINE_STAGE_2_TRANSFER_BIT) access |= VK_ACCESS_2_TRANSFER_WRITE_BIT;
  if (stages & VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT) access |= VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  return access;
}

VkAccessFlags2 readsOf(VkPipelineStageFlags2 stages) {
  constexpr VkPipelineStageFlags2 kShaders = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                                             VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                                             VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  VkAccessFlags2 access = 0;
  if (stages & kAnyStage) access |= VK_ACCESS_2_MEMORY_READ_BIT;
  if (stages & kShaders) access |= VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT;
  if (stages & VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT) access |= VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT;
  if (stages & VK_PIPELINE_STAGE_2_TRANSFER_BIT) access |= VK_ACCESS_2_TRANSFER_READ_BIT;
  if (stages & VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT) access |= VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT;
  if (stages & VK_PIPELINE_STAGE_2_HOST_BIT) access |= VK_ACCESS_2_HOST_READ_BIT;
  return access;
}

VkBufferImageCopy wholeImage(const RenderTarget& target) {
  return {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
          .imageExtent = {std::uint32_t(target.size().x), std::uint32_t(target.size().y), 1}};
}

}  // namespace

std::uint64_t ticksBetween(std::uint64_t first, std::uint64_t second, std::uint32_t bits) {
  return (second - first) & (~std::uint64_t(0) >> (64 - bits));
}

Commands::Commands(const Device& device) : device_(device), slot_(device.queue().borrowSlot()) {
  beginSlice();
}

Commands::~Commands() {
  device_.queue().returnSlot(std::move(slot_));
}

void Commands::beginSlice() {
  if (slices_ == slot_->buffers.size()) {
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = slot_->pool.get(),
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    VkCommandBuffer buffer = VK_NULL_HANDLE;
    VK_CHECK(vkAllocateCommandBuffers(device_.handle(), &info, &buffer));
    slot_->buffers.push_back(buffer);
  }
  buffer_ = slot_->buffers[slices_++];
  sliceMilliseconds_ = 0.0;
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  VK_CHECK(vkBeginCommandBuffer(buffer_, &begin));
}

void Commands::endSlice() {
  if (!passes_.empty()) writeTimestamp();
  // Makes the device's writes visible to the host, which may have the memory mapped, and to later submissions of any
  // thread.
  barrier(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
          VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT);
  VK_CHECK(vkEndCommandBuffer(buffer_));
}

void Commands::nextSlice() {
  endSlice();
  passes_.push_back({});  // the time between two slices belongs to no pass
  beginSlice();
}

/// Whether another slice may begin: not before the first pass, as only passes are measured, and not if timestamps run short.
bool Commands::mayDivide() const {
  return !passes_.empty() && passes_.size() < CommandSlot::kMaxTimestamps / 2;
}

void Commands::writeTimestamp() {
  vkCmdWriteTimestamp2(buffer_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot_->timestamps.get(), slot_->usedTimestamps++);
  // A barrier that orders nothing. Lavapipe writes a timestamp when it reaches the next barrier, which without this one
  // may be after work that was recorded later.
  const VkDependencyInfo nothing{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  if (device_.isCpu()) vkCmdPipelineBarrier2(buffer_, &nothing);
}

void Commands::beginSpan(const std::string& pass) {
  FV_CHECK_LT(slot_->usedTimestamps + 1, CommandSlot::kMaxTimestamps);
  writeTimestamp();
  passes_.push_back({pass, 0.0});
}

void Commands::beginPass(const std::string& name) {
  const double cost = device_.queue().costOf(name, kSliceMilliseconds);
  if (sliceMilliseconds_ > 0.0 && sliceMilliseconds_ + cost > kSliceMilliseconds && mayDivide()) nextSlice();
  pass_ = name;
  beginSpan(name);
  passes_.back().units = 1.0;
  sliceMilliseconds_ += cost;
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
      const bool isWritten = write.descriptorType == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
      images[i] = {
          .sampler = (*texture)->sampler(),
          .imageView = (*texture)->view(),
          .imageLayout = isWritten ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
      write.pImageInfo = &images[i];
    } else {
      images[i] = {.imageView = std::get<const RenderTarget*>(bindings[i])->view(),
                   .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
      write.pImageInfo = &images[i];
    }
    writes.push_back(write);
  }
  vkCmdBindPipeline(buffer_, pipeline.bindPoint(), pipeline.handle());
  if (!writes.empty())
    vkCmdPushDescriptorSetKHR(buffer_, pipeline.bindPoint(), pipeline.layout(), 0, std::uint32_t(writes.size()), writes.data());
  if (pushBytes > 0) vkCmdPushConstants(buffer_, pipeline.layout(), pipeline.stages(), 0, std::uint32_t(pushBytes), push);
}

void Commands::dispatchThreads(const Pipeline& pipeline, const std::function<void()>& bindAll, glm::ivec3 threads) {
  const glm::ivec3 groups = (threads + pipeline.workgroup() - 1) / pipeline.workgroup();
  for (int axis = 0; axis < 3; ++axis)
    FV_CHECK_LE(std::uint32_t(groups[axis]), device_.limits().maxComputeWorkGroupCount[axis]);
  dispatchGroups(bindAll, glm::uvec3(groups), groups.z > 1 ? 2 : groups.y > 1 ? 1 : 0);
}

void Commands::dispatchInvocations(const Pipeline& pipeline, const std::function<void()>& bindAll, std::uint64_t count,
                                   std::uint32_t layers) {
  constexpr std::uint64_t kRow = 65535;  // workgroups that every device supports in one dimension
  const auto threads = std::uint64_t(pipeline.workgroup().x);
  const std::uint64_t groups = (count + threads - 1) / threads;
  const std::uint64_t rows = (groups + kRow - 1) / kRow;
  FV_CHECK_LE(rows, kRow);
  // Several rows are divided between rows only, as the shader reads the length of a row.
  dispatchGroups(bindAll, {std::uint32_t(std::min(groups, kRow)), std::uint32_t(rows), layers}, rows > 1 ? 1 : 0);
}

/// The device time that so many workgroups of the current pass are expected to take.
double Commands::expectedMilliseconds(std::uint64_t groups) const {
  return double(groups) * device_.queue().costOf(pass_, device_.isCpu() ? kUnknownCpuCost : kUnknownGpuCost);
}

/// Begins a slice if work of the current pass is expected not to fit into this one.
void Commands::makeRoomInSlice(double milliseconds) {
  if (sliceMilliseconds_ > 0.0 && sliceMilliseconds_ + milliseconds > kSliceMilliseconds && mayDivide()) {
    nextSlice();
    beginSpan(pass_);
  }
  sliceMilliseconds_ += milliseconds;
}

void Commands::makeRoomForPixels(std::uint64_t pixels) {
  constexpr std::uint64_t kPixelsOfGroup = 64;  // as many as a workgroup of most passes over images has
  const std::uint64_t groups = (pixels + kPixelsOfGroup - 1) / kPixelsOfGroup;
  makeRoomInSlice(expectedMilliseconds(groups));
  countGroups(groups);
}

void Commands::countGroups(std::uint64_t groups) {
  if (!passes_.empty()) passes_.back().units += double(groups);
}

/// Divides the dispatch along `axis` into slices if it is expected to take longer than one.
void Commands::dispatchGroups(const std::function<void()>& bindAll, glm::uvec3 groups, int axis) {
  const std::uint64_t count = std::uint64_t(groups.x) * groups.y * groups.z;
  const double cost = expectedMilliseconds(count);
  std::uint32_t parts = 1;
  if (sliceMilliseconds_ + cost > kSliceMilliseconds && mayDivide())
    parts = std::uint32_t(std::min(std::ceil(cost / kSliceMilliseconds), double(groups[axis])));
  for (std::uint32_t part = 0; part < parts; ++part) {
    const auto boundary = [&](std::uint32_t i) { return std::uint32_t(std::uint64_t(groups[axis]) * i / parts); };
    glm::uvec3 base(0), size = groups;
    base[axis] = boundary(part);
    size[axis] = boundary(part + 1) - base[axis];
    makeRoomInSlice(cost / parts);
    bindAll();
    vkCmdDispatchBase(buffer_, base.x, base.y, base.z, size.x, size.y, size.z);
  }
  countGroups(count);
}

void Commands::fill(const RenderTarget& target, float value) {
  transition(target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
             VK_PIPELINE_STAGE_2_TRANSFER_BIT);
  const VkClearColorValue color{.float32 = {value, value, value, value}};
  const VkImageSubresourceRange whole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  vkCmdClearColorImage(buffer_, target.handle(), VK_IMAGE_LAYOUT_GENERAL, &color, 1, &whole);
  barrier(VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
}

void Commands::copy(const Buffer& from, const Buffer& to, VkBufferCopy region) {
  vkCmdCopyBuffer(buffer_, from.handle(), to.handle(), 1, &region);
  barrier(VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
}

void Commands::copy(const RenderTarget& from, const Buffer& to) {
  const VkBufferImageCopy region = wholeImage(from);
  transition(from, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
             VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_PIPELINE_STAGE_2_TRANSFER_BIT);
  vkCmdCopyImageToBuffer(buffer_, from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(), 1,
                         &region);
  transition(from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL,
             VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
}

void Commands::copy(const Buffer& from, const RenderTarget& to) {
  const VkBufferImageCopy region = wholeImage(to);
  transition(to, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
             VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_TRANSFER_BIT);
  vkCmdCopyBufferToImage(buffer_, from.handle(), to.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
  transition(to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_TRANSFER_BIT,
             VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

void Commands::barrier(VkPipelineStageFlags2 from, VkPipelineStageFlags2 to) {
  const VkMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                .srcStageMask = from,
                                .srcAccessMask = writesOf(from),
                                .dstStageMask = to,
                                .dstAccessMask = readsOf(to) | writesOf(to)};
  const VkDependencyInfo dependency{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &memory};
  vkCmdPipelineBarrier2(buffer_, &dependency);
}

void Commands::transition(VkImage image, VkImageLayout from, VkImageLayout to,
                          VkPipelineStageFlags2 fromStage, VkPipelineStageFlags2 toStage) {
  const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                      .srcStageMask = fromStage,
                                      .srcAccessMask = writesOf(fromStage),
                                      .dstStageMask = toStage,
                                      .dstAccessMask = readsOf(toStage) | writesOf(toStage),
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
  endSlice();
  Queue& queue = device_.queue();
  for (std::size_t slice = 0; slice < slices_; ++slice) {
    if (progress && slices_ > 1) reportProgress(progress);
    waitFor(queue.submit(slot_->buffers[slice]), progress);
  }
  learnCosts();
}

void Commands::waitFor(std::uint64_t submission, const Progress& progress) const {
  const Queue& queue = device_.queue();
  if (!progress) {
    queue.wait(submission);
    return;
  }
  while (!queue.wait(submission, kProgressInterval)) {
    try {
      reportProgress(progress);
    } catch (...) {  // wait before unwinding, so that no resource is freed while in use
      queue.wait(submission);
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
      device_.handle(), slot_->timestamps.get(), 0, std::uint32_t(stamps.size()), stamps.size() * sizeof(Timestamp),
      stamps.data(), sizeof(Timestamp), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
  if (result != VK_NOT_READY) VK_CHECK_RESULT(result, "vkGetQueryPoolResults");
  const auto started =
      std::size_t(std::ranges::count_if(stamps, [](const Timestamp& stamp) { return stamp.available != 0; }));
  std::size_t current = std::min(std::max(started, std::size_t(1)) - 1, passes_.size() - 1);
  if (passes_[current].pass.empty()) ++current;  // a slice is complete and the next one has not begun
  progress(passes_[current].pass, double(current) / double(passes_.size()));
}

/// Device time of each span.
std::vector<double> Commands::milliseconds() const {
  std::vector<std::uint64_t> stamps(passes_.empty() ? 0 : passes_.size() + 1);
  if (stamps.empty()) return {};
  VK_CHECK(vkGetQueryPoolResults(device_.handle(), slot_->timestamps.get(), 0, std::uint32_t(stamps.size()),
                                 stamps.size() * sizeof(std::uint64_t), stamps.data(), sizeof(std::uint64_t),
                                 VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
  std::vector<double> result;
  for (std::size_t i = 0; i < passes_.size(); ++i)
    result.push_back(double(ticksBetween(stamps[i], stamps[i + 1], device_.timestampBits())) *
                     double(device_.limits().timestampPeriod) * 1e-6);
  return result;
}

std::vector<StageTime> Commands::times() const {
  const std::vector<double> spans = milliseconds();
  std::vector<StageTime> times;
  for (std::size_t i = 0; i < passes_.size(); ++i)
    if (!passes_[i].pass.empty()) addTime(times, {passes_[i].pass, spans[i], true});
  return times;
}

void Commands::learnCosts() const {
  const std::vector<double> spans = milliseconds();
  std::map<std::string, Span> passes;
  std::map<std::string, double> sums;
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    if (passes_[i].pass.empty()) continue;
    passes[passes_[i].pass].units += passes_[i].units;
    sums[passes_[i].pass] += spans[i];
  }
  for (const auto& [name, pass] : passes) device_.queue().setCost(name, sums[name] / std::max(pass.units, 1.0));
}

}  // namespace freevoxels
