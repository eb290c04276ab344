// Draws a volume on this program's own Vulkan device, and reads the image with this program's own commands:
// apps/manual/library.md.

#include <cstdio>
#include <freevoxels/vulkan.h>
#include <stdexcept>
#include <vector>

namespace fv = freevoxels::v1;

namespace {

void check(VkResult result, const char* call) {
  if (result != VK_SUCCESS) throw std::runtime_error(std::string(call) + " returned " + std::to_string(result));
}
#define CHECK(call) check(call, #call)

/// The program's own Vulkan, as any renderer or game has it.
struct Vulkan {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t queueFamily = 0;
  VkPhysicalDeviceVulkan13Features vulkan13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceVulkan12Features vulkan12{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &vulkan13};
  VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &vulkan12};
  std::mutex queueMutex;

  Vulkan() {
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    CHECK(vkCreateInstance(&info, nullptr, &instance));
    choosePhysicalDevice();
    chooseQueueFamily();
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queues{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                         .queueFamilyIndex = queueFamily,
                                         .queueCount = 1,
                                         .pQueuePriorities = &priority};
    fv::enableRequiredFeatures(features);  // in addition to the program's own
    const auto extensions = fv::requiredExtensions();
    const VkDeviceCreateInfo deviceInfo{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                        .pNext = &features,
                                        .queueCreateInfoCount = 1,
                                        .pQueueCreateInfos = &queues,
                                        .enabledExtensionCount = std::uint32_t(extensions.size()),
                                        .ppEnabledExtensionNames = extensions.data()};
    CHECK(vkCreateDevice(physicalDevice, &deviceInfo, nullptr, &device));
    vkGetDeviceQueue(device, queueFamily, 0, &queue);
  }
  ~Vulkan() {
    vkDestroyDevice(device, nullptr);
    vkDestroyInstance(instance, nullptr);
  }
  Vulkan(const Vulkan&) = delete;

  void choosePhysicalDevice() {
    std::uint32_t count = 0;
    CHECK(vkEnumeratePhysicalDevices(instance, &count, nullptr));
    std::vector<VkPhysicalDevice> devices(count);
    CHECK(vkEnumeratePhysicalDevices(instance, &count, devices.data()));
    for (VkPhysicalDevice candidate : devices)
      if (physicalDevice == VK_NULL_HANDLE && fv::whyUnusable(instance, candidate).empty()) physicalDevice = candidate;
    if (physicalDevice == VK_NULL_HANDLE) throw std::runtime_error("no Vulkan device can be used");
  }
  void chooseQueueFamily() {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice, &count, families.data());
    constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    while (queueFamily < count && (families[queueFamily].queueFlags & kNeeded) != kNeeded) ++queueFamily;
  }
};

/// A buffer that the host reads, and the commands that copy a frame into it.
class Reader {
 public:
  Reader(Vulkan& vulkan, VkExtent2D extent) : vulkan_(vulkan), bytes_(VkDeviceSize(extent.width) * extent.height * 4 * sizeof(float)) {
    const VkBufferCreateInfo bufferInfo{
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes_, .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    CHECK(vkCreateBuffer(vulkan_.device, &bufferInfo, nullptr, &buffer_));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(vulkan_.device, buffer_, &needs);
    const VkMemoryAllocateInfo memoryInfo{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                          .allocationSize = needs.size,
                                          .memoryTypeIndex = hostVisibleType(needs.memoryTypeBits)};
    CHECK(vkAllocateMemory(vulkan_.device, &memoryInfo, nullptr, &memory_));
    CHECK(vkBindBufferMemory(vulkan_.device, buffer_, memory_, 0));
    const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, .queueFamilyIndex = vulkan_.queueFamily};
    CHECK(vkCreateCommandPool(vulkan_.device, &poolInfo, nullptr, &pool_));
  }
  ~Reader() {
    vkDestroyCommandPool(vulkan_.device, pool_, nullptr);
    vkFreeMemory(vulkan_.device, memory_, nullptr);
    vkDestroyBuffer(vulkan_.device, buffer_, nullptr);
  }
  Reader(const Reader&) = delete;

  fv::Image read(const fv::DeviceFrame& frame) {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    const VkCommandBufferAllocateInfo allocation{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                 .commandPool = pool_,
                                                 .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                 .commandBufferCount = 1};
    CHECK(vkAllocateCommandBuffers(vulkan_.device, &allocation, &commands));
    record(commands, frame);
    submit(commands, frame);
    fv::Image image{.width = int(frame.extent.width), .height = int(frame.extent.height)};
    void* mapped = nullptr;
    CHECK(vkMapMemory(vulkan_.device, memory_, 0, VK_WHOLE_SIZE, 0, &mapped));
    const float* const floats = static_cast<const float*>(mapped);
    image.pixels.assign(floats, floats + bytes_ / sizeof(float));
    vkUnmapMemory(vulkan_.device, memory_);
    return image;
  }

 private:
  void record(VkCommandBuffer commands, const fv::DeviceFrame& frame) {
    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    CHECK(vkBeginCommandBuffer(commands, &begin));
    const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                   .imageExtent = {frame.extent.width, frame.extent.height, 1}};
    vkCmdCopyImageToBuffer(commands, frame.color.image, VK_IMAGE_LAYOUT_GENERAL, buffer_, 1, &region);
    const VkMemoryBarrier2 forHost{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                   .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                   .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo barrier{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &forHost};
    vkCmdPipelineBarrier2(commands, &barrier);
    CHECK(vkEndCommandBuffer(commands));
  }

  void submit(VkCommandBuffer commands, const fv::DeviceFrame& frame) {
    const VkSemaphoreSubmitInfo whenComplete{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                             .semaphore = frame.semaphore,
                                             .value = frame.value,
                                             .stageMask = VK_PIPELINE_STAGE_2_COPY_BIT};
    const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, .commandBuffer = commands};
    const VkSubmitInfo2 info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             .waitSemaphoreInfoCount = 1,
                             .pWaitSemaphoreInfos = &whenComplete,
                             .commandBufferInfoCount = 1,
                             .pCommandBufferInfos = &buffer};
    const std::lock_guard lock(vulkan_.queueMutex);  // the renderer may be submitting the next frame
    CHECK(vkQueueSubmit2(vulkan_.queue, 1, &info, VK_NULL_HANDLE));
    CHECK(vkQueueWaitIdle(vulkan_.queue));
  }

  std::uint32_t hostVisibleType(std::uint32_t allowed) const {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(vulkan_.physicalDevice, &memory);
    constexpr VkMemoryPropertyFlags kWanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type)
      if ((allowed >> type & 1) && (memory.memoryTypes[type].propertyFlags & kWanted) == kWanted) return type;
    throw std::runtime_error("the device has no memory that the host reads");
  }

  Vulkan& vulkan_;
  const VkDeviceSize bytes_;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
};

}  // namespace

int main(int count, char** arguments) {
  try {
    Vulkan vulkan;
    const fv::Context context = fv::adopt({.instance = vulkan.instance,
                                           .physicalDevice = vulkan.physicalDevice,
                                           .device = vulkan.device,
                                           .queue = vulkan.queue,
                                           .queueFamily = vulkan.queueFamily,
                                           .features = &vulkan.features,
                                           .queueMutex = &vulkan.queueMutex});
    const fv::Volume volume = fv::Volume::open(context, count > 1 ? arguments[1] : "procedural:cloud");
    fv::Renderer renderer(context, volume, R"({"size": [640, 480], "camera": {"fov": 30}, "orbit": [120, 20]})");

    // The second frame is drawn while the first one is read and written.
    fv::Frame first = renderer.submit(R"({"orbit": [120, 20]})");
    fv::Frame second = renderer.submit(R"({"orbit": [240, 20]})");
    Reader reader(vulkan, {640, 480});
    fv::save("interop_120.png", reader.read(fv::deviceFrame(first)));
    fv::save("interop_240.png", reader.read(fv::deviceFrame(second)));
    std::printf("interop_120.png and interop_240.png of %s, on %s\n", volume.source().c_str(), context.device().c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "interop: %s\n", error.what());
    return 1;
  }
}
