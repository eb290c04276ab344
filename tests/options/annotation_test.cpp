// Bars over images.
#include "apps/common/annotation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "apps/common/image_text.h"

namespace freevoxels {
namespace {

/// A slice of 20 x 20 units of the world, seen in 400 x 400 pixels.
struct Annotated {
  SceneDescription description;
  Scene scene;
  Image image{.size = {400, 400}, .pixels = std::vector<glm::vec4>(400 * 400, glm::vec4(0.0f))};

  Annotated() {
    description.method.annotate = true;
    description.method.slice = SlicePlane{};
    scene.volume = std::make_shared<const Volume>();
    scene.camera = {.orthographic = true, .orthographicHeight = 20.0};
  }
  glm::vec4 at(int x, int y) const { return image.pixels[std::size_t(y) * 400 + std::size_t(x)]; }
  void draw() { annotate(image, description, scene); }
};

TEST(Annotation, ValuesAreThreeToFiveRoundOnes) {
  EXPECT_EQ(roundValues(0.0, 1.0), (std::vector{0.0, 0.25, 0.5, 0.75, 1.0}));
  EXPECT_EQ(roundValues(-160.0, 240.0), (std::vector{-100.0, 0.0, 100.0, 200.0}));
  for (double low = -3.7; low < 4.0; low += 0.31)
    for (double width = 1e-5; width < 1e6; width *= 1.7) {
      const std::vector<double> values = roundValues(low, low + width);
      EXPECT_GE(values.size(), 3u) << low << " " << width;
      EXPECT_LE(values.size(), 5u) << low << " " << width;
    }
}

TEST(Annotation, LengthsAreRoundAndHaveUnits) {
  EXPECT_EQ(roundLength(4.9), 2.0);
  EXPECT_EQ(roundLength(5.0), 5.0);
  EXPECT_DOUBLE_EQ(roundLength(0.0123), 0.01);
  EXPECT_EQ(lengthText(50.0, "mm"), "50 mm");
  EXPECT_EQ(lengthText(100.0, "mm"), "10 cm");
  EXPECT_EQ(lengthText(0.02, "mm"), "20 \u00b5m");
  EXPECT_EQ(lengthText(1e-5, "mm"), "10 nm");
  EXPECT_EQ(lengthText(0.2, ""), "0.2");
}

TEST(Annotation, UnitsAreThoseOfTheVolume) {
  Annotated none, millimetres;
  millimetres.scene.volume = std::make_shared<const Volume>(Volume{.lengthUnit = "mm"});
  none.draw();
  millimetres.draw();
  EXPECT_NE(none.image.pixels, millimetres.image.pixels);
}

TEST(Annotation, TheScaleBarIsAsLongAsItSays) {
  Annotated one;  // 20 pixels a unit, of which a quarter of the width are 5
  one.draw();
  int longest = 0, run = 0;
  for (int x = 0; x < 400; ++x) {
    run = one.at(x, 387) == glm::vec4(1.0f) ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  EXPECT_EQ(longest, 100);
}

TEST(Annotation, TheColourBarHasTheColoursOfTheFunction) {
  Annotated one;
  one.scene.classification.transferFunction =
      TransferFunction{.opacity = {{10.0f, 0.1f}, {20.0f, 0.1f}}, .color = {{10.0f, glm::vec3(1, 0, 0)}, {20.0f, glm::vec3(0, 0, 1)}}};
  one.draw();
  for (const int y : {110, 200, 290}) {
    const float part = (299.5f - float(y)) / 200.0f;
    const glm::vec4 shown = one.at(384, y);
    EXPECT_NEAR(shown.b, part, 3e-3f) << y;
    EXPECT_NEAR(shown.r, 1.0f - part, 3e-3f) << y;
    EXPECT_EQ(shown.a, 1.0f);
  }
}

TEST(Annotation, InkIsBlackOverWhatIsBright) {
  Annotated one;
  one.image.pixels.assign(400 * 400, glm::vec4(1.0f));
  one.draw();
  EXPECT_EQ(one.at(60, 387), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
}

TEST(Annotation, NothingIsDrawnUnlessItIsAskedForOrCanBe) {
  Annotated one;
  const Image before = one.image;
  one.description.method.annotate = false;
  one.draw();
  EXPECT_EQ(one.image.pixels, before.pixels);
  one.description.method.annotate = true;
  one.scene.camera.orthographic = false;
  EXPECT_FALSE(canAnnotate(one.description, one.scene));
  one.draw();
  EXPECT_EQ(one.image.pixels, before.pixels);
}

TEST(Annotation, ImagesOfAnySizeAreAnnotated) {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(7, 300), glm::ivec2(300, 7), glm::ivec2(33, 20)}) {
    Annotated one;
    one.scene.classification.transferFunction =
        TransferFunction{.opacity = {{-1e9f, 0.1f}, {1e-9f, 0.1f}}, .color = {{0.0f, glm::vec3(1.0f)}}};
    one.image = {.size = size, .pixels = std::vector<glm::vec4>(std::size_t(size.x) * std::size_t(size.y))};
    one.draw();
    for (const glm::vec4& pixel : one.image.pixels) EXPECT_TRUE(std::isfinite(pixel.r + pixel.a));
  }
}

TEST(ImageText, DigitsAreAsHighAsTheySay) {
  Image image{.size = {100, 100}, .pixels = std::vector<glm::vec4>(100 * 100)};
  drawText(image, {10.0, 80.0}, "I", 60.0, {});
  int first = 100, last = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x)
      if (image.pixels[std::size_t(y) * 100 + std::size_t(x)].r > 0.5f) first = std::min(first, y), last = std::max(last, y);
  EXPECT_NEAR(last - first + 1, textHeight(60.0), 1.5);
  EXPECT_NEAR(last, 79, 1);
  EXPECT_DOUBLE_EQ(textWidth("12", 30.0), 2.0 * textWidth("1", 30.0));
  EXPECT_GT(textWidth("\u00b5", 30.0), 0.0);
}

TEST(ImageText, RectanglesCoverPixelsInPart) {
  Image image{.size = {4, 1}, .pixels = std::vector<glm::vec4>(4)};
  fillRectangle(image, {0.75, -3.0}, {2.5, 9.0}, glm::vec3(1.0f));
  EXPECT_EQ(image.pixels[0].r, 0.25f);
  EXPECT_EQ(image.pixels[1].r, 1.0f);
  EXPECT_EQ(image.pixels[2].r, 0.5f);
  EXPECT_EQ(image.pixels[3].r, 0.0f);
}

}  // namespace
}  // namespace freevoxels
