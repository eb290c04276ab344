#include "engine/vulkan/pipeline.h"

#include <algorithm>
#include <array>
#include <exception>
#include <initializer_list>
#include <system_error>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

OwnedShaderModule makeModule(const Device& device, const Shader& code) {
  const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                      .codeSize = code.words.size_bytes(),
                                      .pCode = code.words.data()};
  VkShaderModule module = VK_NULL_HANDLE;
  VK_CHECK(vkCreateShaderModule(device.handle(), &info, nullptr, &module));
  device.setName(VK_OBJECT_TYPE_SHADER_MODULE, std::uint64_t(module), code.name);
  return {device.handle(), module};
}

/// Keeps the map entries alive as long as the VkSpecializationInfo that points to them.
class SpecialisationInfo {
 public:
  explicit SpecialisationInfo(const Specialisation& constants) {
    for (std::uint32_t i = 0; i < constants.size(); ++i)
      entries_.push_back({.constantID = i, .offset = i * 4, .size = 4});
    info_ = {.mapEntryCount = std::uint32_t(entries_.size()),
             .pMapEntries = entries_.data(),
             .dataSize = constants.size() * 4,
             .pData = constants.data()};
  }
  SpecialisationInfo(const SpecialisationInfo&) = delete;
  const VkSpecializationInfo* get() const { return &info_; }

 private:
  std::vector<VkSpecializationMapEntry> entries_;
  VkSpecializationInfo info_{};
};

VkPipelineColorBlendAttachmentState blendState(Blend blend) {
  const VkBlendFactor kept =
      blend == Blend::Additive ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  return {.blendEnable = blend == Blend::Replace ? VK_FALSE : VK_TRUE,
          .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
          .dstColorBlendFactor = kept,
          .colorBlendOp = VK_BLEND_OP_ADD,
          .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
          .dstAlphaBlendFactor = kept,
          .alphaBlendOp = VK_BLEND_OP_ADD,
          .colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT};
}

/// The fixed-function state of a graphics pipeline.
struct FixedState {
  FixedState(VkPrimitiveTopology topology, std::size_t attachments, Blend mode)
      : blends(attachments, blendState(mode)) {
    assembly.topology = topology;
    blend.attachmentCount = std::uint32_t(blends.size());
    blend.pAttachments = blends.data();
  }
  FixedState(const FixedState&) = delete;

  static constexpr std::array kDynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};

  std::vector<VkPipelineColorBlendAttachmentState> blends;
  VkPipelineVertexInputStateCreateInfo vertexInput{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
  VkPipelineRasterizationStateCreateInfo raster{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .polygonMode = VK_POLYGON_MODE_FILL,
      .cullMode = VK_CULL_MODE_NONE,
      .lineWidth = 1.0f};
  VkPipelineMultisampleStateCreateInfo multisample{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
      .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  VkPipelineColorBlendStateCreateInfo blend{.sType =
                                                VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  VkPipelineDynamicStateCreateInfo dynamic{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                           .dynamicStateCount = std::uint32_t(kDynamic.size()),
                                           .pDynamicStates = kDynamic.data()};
};

VkShaderStageFlags stagesOf(VkPipelineBindPoint bindPoint) {
  return bindPoint == VK_PIPELINE_BIND_POINT_COMPUTE
             ? VkShaderStageFlags(VK_SHADER_STAGE_COMPUTE_BIT)
             : VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
}

/// The bindings and push constants of all stages together.
PipelineInterface interfaceOf(std::initializer_list<const Shader*> stages) {
  PipelineInterface interface;
  for (const Shader* stage : stages) {
    interface.pushConstantBytes = std::max(interface.pushConstantBytes, stage->pushConstantBytes);
    interface.bindings.resize(std::max(interface.bindings.size(), stage->bindings.size()), kNoBinding);
    for (std::size_t i = 0; i < stage->bindings.size(); ++i)
      if (stage->bindings[i] != kNoBinding) interface.bindings[i] = stage->bindings[i];
  }
  FV_CHECK_EQ(std::ranges::count(interface.bindings, kNoBinding), 0);
  return interface;
}

PipelineLayout makeLayout(const Device& device, std::initializer_list<const Shader*> shaders, VkPipelineBindPoint bindPoint) {
  PipelineLayout result{.interface = interfaceOf(shaders), .bindPoint = bindPoint, .workgroup = (*shaders.begin())->workgroup};
  const PipelineInterface& interface = result.interface;
  FV_CHECK_LE(interface.pushConstantBytes, device.limits().maxPushConstantsSize);
  const VkShaderStageFlags stages = stagesOf(bindPoint);
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (std::uint32_t i = 0; i < interface.bindings.size(); ++i)
    bindings.push_back(
        {.binding = i, .descriptorType = interface.bindings[i], .descriptorCount = 1, .stageFlags = stages});
  const VkDescriptorSetLayoutCreateInfo setInfo{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR,
      .bindingCount = std::uint32_t(bindings.size()),
      .pBindings = bindings.data()};
  VkDescriptorSetLayout set = VK_NULL_HANDLE;
  VK_CHECK(vkCreateDescriptorSetLayout(device.handle(), &setInfo, nullptr, &set));
  result.set = OwnedSetLayout(device.handle(), set);

  const VkPushConstantRange range{.stageFlags = stages, .offset = 0, .size = interface.pushConstantBytes};
  const VkPipelineLayoutCreateInfo layoutInfo{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
      .setLayoutCount = 1,
      .pSetLayouts = &set,
      .pushConstantRangeCount = interface.pushConstantBytes > 0 ? 1u : 0u,
      .pPushConstantRanges = &range};
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VK_CHECK(vkCreatePipelineLayout(device.handle(), &layoutInfo, nullptr, &layout));
  result.layout = OwnedPipelineLayout(device.handle(), layout);
  return result;
}

OwnedPipeline compileCompute(const Device& device, VkPipelineCache cache, VkPipelineLayout layout, const Shader& code,
                             const Specialisation& constants) {
  const OwnedShaderModule module = makeModule(device, code);
  const SpecialisationInfo specialisation(constants);
  const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         .flags = VK_PIPELINE_CREATE_DISPATCH_BASE,
                                         .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                   .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                   .module = module.get(),
                                                   .pName = "main",
                                                   .pSpecializationInfo = specialisation.get()},
                                         .layout = layout};
  VkPipeline pipeline = VK_NULL_HANDLE;
  VK_CHECK(vkCreateComputePipelines(device.handle(), cache, 1, &info, nullptr, &pipeline));
  device.setName(VK_OBJECT_TYPE_PIPELINE, std::uint64_t(pipeline), code.name);
  return {device.handle(), pipeline};
}

OwnedPipeline compileGraphics(const Device& device, VkPipelineCache cache, VkPipelineLayout layout, const Shader& vertex,
                              const Shader& fragment, const PipelineKey& key) {
  const OwnedShaderModule vertexModule = makeModule(device, vertex);
  const OwnedShaderModule fragmentModule = makeModule(device, fragment);
  const SpecialisationInfo specialisation(key.constants);
  const std::array stages{
      VkPipelineShaderStageCreateInfo{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                      .stage = VK_SHADER_STAGE_VERTEX_BIT,
                                      .module = vertexModule.get(),
                                      .pName = "main",
                                      .pSpecializationInfo = specialisation.get()},
      VkPipelineShaderStageCreateInfo{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                      .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
                                      .module = fragmentModule.get(),
                                      .pName = "main",
                                      .pSpecializationInfo = specialisation.get()}};
  const FixedState state(key.topology, key.attachments.size(), key.blend);
  const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                .colorAttachmentCount = std::uint32_t(key.attachments.size()),
                                                .pColorAttachmentFormats = key.attachments.data()};
  const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .pNext = &rendering,
                                          .stageCount = std::uint32_t(stages.size()),
                                          .pStages = stages.data(),
                                          .pVertexInputState = &state.vertexInput,
                                          .pInputAssemblyState = &state.assembly,
                                          .pViewportState = &state.viewport,
                                          .pRasterizationState = &state.raster,
                                          .pMultisampleState = &state.multisample,
                                          .pColorBlendState = &state.blend,
                                          .pDynamicState = &state.dynamic,
                                          .layout = layout};
  VkPipeline pipeline = VK_NULL_HANDLE;
  VK_CHECK(vkCreateGraphicsPipelines(device.handle(), cache, 1, &info, nullptr, &pipeline));
  device.setName(VK_OBJECT_TYPE_PIPELINE, std::uint64_t(pipeline), fragment.name);
  return {device.handle(), pipeline};
}

/// Threads that compile ahead: one fewer than there are processors, but at least one, and no more than this.
constexpr std::size_t kMaxThreads = 4;

}  // namespace

VkPipeline Pipeline::handle() const {
  store_->compile(*stored_);
  return stored_->pipeline.get();
}

PipelineStore::~PipelineStore() {
  stopCompilingAhead();
}

void PipelineStore::stopCompilingAhead() {
  std::vector<std::thread> threads;
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    threads.swap(threads_);
  }
  changed_.notify_all();
  for (std::thread& thread : threads) thread.join();
}

Pipeline PipelineStore::get(const PipelineKey& key, const std::function<PipelineLayout()>& makeLayout, const Compiler& compile) {
  const std::lock_guard lock(mutex_);
  const auto [place, isNew] = pipelines_.try_emplace(key);
  StoredPipeline& stored = place->second;
  if (!isNew) return {*this, stored};
  try {
    stored.layout = makeLayout();
    stored.compile = [this, &stored, compile] { return compile(cache_.handle(), stored.layout.layout.get()); };
    wanted_.push_back(&stored);
  } catch (...) {
    pipelines_.erase(place);
    throw;
  }
  changed_.notify_all();
  addThread();
  return {*this, stored};
}

/// Adds a thread if there is work for another one. Called with `mutex_` locked.
void PipelineStore::addThread() {
  const std::size_t mostThreads = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 2, kMaxThreads + 1) - 1;
  if (closing_ || idle_ >= wanted_.size() || threads_.size() >= mostThreads) return;
  try {
    threads_.emplace_back([this] { compileAhead(); });
  } catch (const std::system_error&) {  // There are no more threads: the caller compiles the pipeline when it binds it.
  }
}

void PipelineStore::compile(StoredPipeline& stored) {
  using enum StoredPipeline::State;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return stored.state != Compiling; });
  if (stored.state == Compiled) return;
  stored.state = Compiling;
  lock.unlock();
  std::vector<StageTime> times;
  std::exception_ptr error;
  try {
    const StageTimer timer(times, "make pipelines");
    stored.pipeline = stored.compile();
  } catch (...) {
    error = std::current_exception();
  }
  lock.lock();
  stored.state = error ? Wanted : Compiled;
  addTimes(times_, times);
  lock.unlock();
  changed_.notify_all();
  if (error) std::rethrow_exception(error);
}

void PipelineStore::compileAhead() {
  std::unique_lock lock(mutex_);
  for (;;) {
    ++idle_;
    changed_.wait(lock, [&] { return closing_ || !wanted_.empty(); });
    --idle_;
    if (closing_) return;
    StoredPipeline& next = *wanted_.front();
    wanted_.pop_front();
    if (next.state != StoredPipeline::State::Wanted) continue;
    lock.unlock();
    try {
      compile(next);
    } catch (...) {  // The thread that binds the pipeline compiles it again and gets the error.
    }
    lock.lock();
  }
}

std::vector<StageTime> PipelineStore::times() const {
  const std::lock_guard lock(mutex_);
  return times_;
}

VkShaderStageFlags Pipeline::stages() const {
  return stagesOf(bindPoint());
}

Pipeline makeComputePipeline(const Device& device, const Shader& shader, const Specialisation& constants) {
  const PipelineKey key{.code = {shader.words.data(), nullptr}, .constants = constants};
  return device.pipelines().get(
      key, [&] { return makeLayout(device, {&shader}, VK_PIPELINE_BIND_POINT_COMPUTE); },
      [&device, &shader, constants](VkPipelineCache cache, VkPipelineLayout layout) {
        return compileCompute(device, cache, layout, shader, constants);
      });
}

Pipeline makeGraphicsPipeline(const Device& device, const Shader& vertex, const Shader& fragment, VkPrimitiveTopology topology,
                              std::span<const VkFormat> attachments, Blend blend, const Specialisation& constants) {
  const PipelineKey key{.code = {vertex.words.data(), fragment.words.data()},
                        .constants = constants,
                        .topology = topology,
                        .attachments = {attachments.begin(), attachments.end()},
                        .blend = blend};
  return device.pipelines().get(
      key,
      [&] {
        return makeLayout(device, {&vertex, &fragment}, VK_PIPELINE_BIND_POINT_GRAPHICS);
      },
      [&device, &vertex, &fragment, key](VkPipelineCache cache, VkPipelineLayout layout) {
        return compileGraphics(device, cache, layout, vertex, fragment, key);
      });
}

}  // namespace freevoxels
