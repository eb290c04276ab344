#include "apps/view/sample_images.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "apps/view/session_store.h"
#include "engine/image/decode_png.h"
#include "engine/volume/procedural.h"

namespace freevoxels {
namespace {

TEST(SampleImages, ShowEachProceduralVolume) {
  for (const ProceduralKind& kind : proceduralKinds()) {
    const std::span<const unsigned char> bytes = sampleImage(kind.name);
    ASSERT_FALSE(bytes.empty()) << kind.name;
    const Image image = decodePng(std::string(kind.name), bytes);
    EXPECT_EQ(image.size, SessionStore::kThumbnailSize) << kind.name;
    const auto differs = [&](const glm::vec4& pixel) { return glm::distance(pixel, image.pixels.front()) > 0.1f; };
    EXPECT_GT(std::ranges::count_if(image.pixels, differs), int(image.pixels.size()) / 20) << kind.name;
  }
  EXPECT_TRUE(sampleImage("none").empty());
}

}  // namespace
}  // namespace freevoxels
