// The display pass beside the PNG writer's bytes.

#include "engine/image/display_pass.h"

#include <cmath>
#include <limits>
#include <random>

#include "tests/device/device_fixture.h"

namespace freevoxels {
namespace {

class DisplayPassTest : public DeviceTest {
 protected:
  /// Pixels of all alphas; some brighter than 1, some brighter than their alpha, some with values that are no light.
  static Image testImage() {
    Image image{.size = {67, 41}};
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    for (int i = 0; i < image.size.x * image.size.y; ++i) {
      const float alpha = uniform(generator) * 1.1f, brightness = std::exp2(8.0f * uniform(generator) - 7.0f);
      image.pixels.emplace_back(alpha * brightness * uniform(generator), alpha * brightness * uniform(generator),
                                alpha * brightness * uniform(generator), alpha);
    }
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    image.pixels[0] = glm::vec4(0.0f);
    image.pixels[1] = glm::vec4(1.0f);
    image.pixels[2] = glm::vec4(-0.5f, 0.2f, 0.3f, 0.5f);
    image.pixels[3] = glm::vec4(nan, 0.2f, 0.3f, 0.5f);
    image.pixels[4] = glm::vec4(infinity, 0.2f, 0.3f, 0.5f);
    return image;
  }
  static std::vector<std::uint8_t> shown(const Image& image, const DisplayLook& look) {
    const DisplayPass pass(device());
    const RenderTarget target = uploadImage(device(), image);
    const Texture texture(device(), image.size, "shown");
    Commands commands(device());
    pass.record(commands, target, look, texture);
    const Buffer bytes(device(), image.pixels.size() * 4, MemoryUse::Readback, "shown");
    commands.transition(texture.handle(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                        VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_PIPELINE_STAGE_2_TRANSFER_BIT);
    const VkBufferImageCopy region{
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .imageExtent = {std::uint32_t(image.size.x), std::uint32_t(image.size.y), 1}};
    vkCmdCopyImageToBuffer(commands.handle(), texture.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, bytes.handle(), 1,
                           &region);
    commands.submitAndWait();
    std::vector<std::uint8_t> result(image.pixels.size() * 4);
    download(device(), bytes, std::as_writable_bytes(std::span(result)));
    return result;
  }
};

TEST_F(DisplayPassTest, ShowsTheBytesOfThePngWriter) {
  const Image image = testImage();
  const Background gradient{.top = {0.4f, 0.1f, 0.02f}, .bottom = {0.0f, 0.3f, 0.9f}};
  for (const auto& background : {std::optional<Background>(), std::optional(gradient)})
    for (const ToneMap map : {ToneMap::None, ToneMap::Filmic, ToneMap::Aces})
      for (const double exposure : {0.0, -1.5, 2.0}) {
        const DisplayLook look{.background = background, .exposure = exposure, .toneMap = map};
        const std::vector<std::uint8_t> expected = srgbTexels(image, look), found = shown(image, look);
        ASSERT_EQ(found.size(), expected.size());
        int largest = 0, different = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
          if (found[i | 3] == 0 && expected[i | 3] == 0) continue;  // invisible, of any colour
          largest = std::max(largest, std::abs(int(found[i]) - int(expected[i])));
          different += found[i] != expected[i] ? 1 : 0;
        }
        EXPECT_LE(largest, map == ToneMap::None ? 0 : 1)
            << "tone map " << int(map) << ", exposure " << exposure << (background ? ", background" : "");
        EXPECT_LE(different, int(found.size() / 1000));
      }
}

TEST_F(DisplayPassTest, AnUploadedImageComesBack) {
  const Image image = testImage();
  const RenderTarget target = uploadImage(device(), image);
  EXPECT_EQ(target.size(), image.size);
  const auto bytes = shown(image, {});
  EXPECT_EQ(bytes[7], 255) << "alpha 1 of the second pixel";
  EXPECT_EQ(bytes[3], 0);
}

}  // namespace
}  // namespace freevoxels
