// Drawing on a device of the caller's, which links the Vulkan loader itself.

#include <freevoxels/vulkan.h>
#include <gtest/gtest.h>

#include <vector>

namespace freevoxels {
namespace {

constexpr const char* kSmall = R"({"size": [48, 40], "density-scale": 20})";

/// An instance and a device that lacks what the test takes away.
class AdoptedDeviceTest : public ::testing::Test {
 protected:
  AdoptedDeviceTest() {
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    EXPECT_EQ(vkCreateInstance(&info, nullptr, &adopted_.instance), VK_SUCCESS);
    std::uint32_t one = 1;
    vkEnumeratePhysicalDevices(adopted_.instance, &one, &adopted_.physicalDevice);
    EXPECT_EQ(v1::whyUnusable(adopted_.instance, adopted_.physicalDevice), "");
    v1::enableRequiredFeatures(features_);
    extensions_.assign(v1::requiredExtensions().begin(), v1::requiredExtensions().end());
  }
  ~AdoptedDeviceTest() override {
    vkDestroyDevice(adopted_.device, nullptr);
    vkDestroyInstance(adopted_.instance, nullptr);
  }

  v1::Context adopt(int memoryLimit = 0) {
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue{
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &features_,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue,
                                  .enabledExtensionCount = std::uint32_t(extensions_.size()),
                                  .ppEnabledExtensionNames = extensions_.data()};
    EXPECT_EQ(vkCreateDevice(adopted_.physicalDevice, &info, nullptr, &adopted_.device), VK_SUCCESS);
    vkGetDeviceQueue(adopted_.device, 0, 0, &adopted_.queue);
    adopted_.features = &features_;
    return v1::adopt(adopted_, memoryLimit);
  }
  void expectRefused(v1::ErrorKind kind, const std::string& part) {
    try {
      adopt();
      ADD_FAILURE() << "no error, but expected: " << part;
    } catch (const v1::Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }

  VkPhysicalDeviceVulkan13Features vulkan13_{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceVulkan12Features vulkan12_{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &vulkan13_};
  VkPhysicalDeviceFeatures2 features_{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &vulkan12_};
  std::vector<const char*> extensions_;
  v1::AdoptedDevice adopted_;
};

TEST_F(AdoptedDeviceTest, DrawsWhatAnOwnDeviceDraws) {
  const v1::Volume volume = v1::Volume::open("procedural:cloud", R"({"resolution": 32})");
  const v1::Image expected = v1::Renderer(volume, kSmall).render("{}", {.depth = true});
  const v1::Context context = adopt();
  v1::Renderer renderer(context, volume, kSmall);
  EXPECT_EQ(context.device(), renderer.device());
  const v1::Frame frame = renderer.submit("{}", {.depth = true});
  const v1::Image image = frame.image();
  EXPECT_EQ(image.pixels, expected.pixels);
  EXPECT_EQ(image.depth, expected.depth);
}

TEST_F(AdoptedDeviceTest, HandsOverTheImagesOfAFrame) {
  v1::Renderer renderer(adopt(), v1::Volume::open("procedural:cloud", R"({"resolution": 32})"), kSmall);
  const v1::Frame frame = renderer.submit("{}", {.depth = true}), withoutDepth = renderer.submit();
  const v1::DeviceFrame images = v1::deviceFrame(frame);
  EXPECT_EQ(images.color.format, VK_FORMAT_R32G32B32A32_SFLOAT);
  EXPECT_EQ(images.depth.format, VK_FORMAT_R32_SFLOAT);
  EXPECT_EQ(images.extent.width, 48u);
  EXPECT_EQ(images.extent.height, 40u);
  std::uint64_t value = 0;
  ASSERT_EQ(vkGetSemaphoreCounterValue(adopted_.device, images.semaphore, &value), VK_SUCCESS);
  EXPECT_GE(value, images.value);
  const v1::DeviceFrame other = v1::deviceFrame(withoutDepth);
  EXPECT_NE(other.color.image, images.color.image) << "the first frame is still held";
  EXPECT_EQ(other.depth.image, VkImage(VK_NULL_HANDLE));
}

TEST_F(AdoptedDeviceTest, FramesOfOwnDevicesAreNotHandedOver) {
  v1::Renderer renderer(v1::Volume::open("procedural:cloud", R"({"resolution": 32})"), kSmall);
  EXPECT_THROW(v1::deviceFrame(renderer.submit()), v1::Error);
}

TEST_F(AdoptedDeviceTest, LimitsItsMemory) {
  v1::Renderer renderer(adopt(1), v1::Volume::open("procedural:cloud", R"({"resolution": 32})"), R"({"size": [400, 400]})");
  const v1::Frame frame = renderer.submit();
  try {
    frame.wait();
    ADD_FAILURE() << "a frame of 2.5 MiB in 1 MiB";
  } catch (const v1::Error& error) {
    EXPECT_EQ(error.kind(), v1::ErrorKind::OutOfMemory);
    EXPECT_EQ(error.parameters(), std::vector<std::string>{"size"});
  }
}

TEST_F(AdoptedDeviceTest, IsRefusedWithoutARequiredFeature) {
  vulkan12_.timelineSemaphore = VK_FALSE;
  expectRefused(v1::ErrorKind::Device, "it was created without the feature timelineSemaphore");
}

TEST_F(AdoptedDeviceTest, IsRefusedWithoutARequiredExtension) {
  extensions_.clear();
  expectRefused(v1::ErrorKind::Device, "it was created without the extension VK_KHR_push_descriptor");
}

TEST_F(AdoptedDeviceTest, IsRefusedWithoutTheStructsOfItsFeatures) {
  features_.pNext = &vulkan13_;
  expectRefused(v1::ErrorKind::Device, "VkPhysicalDeviceVulkan12Features");
}

TEST_F(AdoptedDeviceTest, IsRefusedWithAQueueFamilyThatDoesNotExist) {
  adopted_.queueFamily = 99;
  expectRefused(v1::ErrorKind::Device, "queue family 99");
}

TEST_F(AdoptedDeviceTest, IsRefusedWithNullHandles) {
  EXPECT_THROW(v1::adopt({.instance = adopted_.instance}), v1::Error);
}

}  // namespace
}  // namespace freevoxels
