#include <cstdio>  // before jpeglib.h

#include <gtest/gtest.h>
#include <jpeglib.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/image/image.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::readBytes;
using test::TemporaryFolder;

struct Jpeg {
  glm::ivec2 size{0};
  int channels = 0, chromaWidth = 0;
  std::vector<std::uint8_t> samples;
};

Jpeg read(const std::string& bytes) {
  jpeg_decompress_struct state{};
  jpeg_error_mgr errors{};
  state.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&state);
  jpeg_mem_src(&state, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&state, TRUE);
  jpeg_start_decompress(&state);
  Jpeg jpeg{.size = {int(state.output_width), int(state.output_height)}, .channels = state.output_components,
            .chromaWidth = int(state.comp_info[1].downsampled_width)};
  jpeg.samples.resize(std::size_t(jpeg.size.x * jpeg.size.y * jpeg.channels));
  while (state.output_scanline < state.output_height) {
    JSAMPROW row = jpeg.samples.data() + std::size_t(state.output_scanline) * std::size_t(jpeg.size.x * jpeg.channels);
    jpeg_read_scanlines(&state, &row, 1);
  }
  jpeg_finish_decompress(&state);
  jpeg_destroy_decompress(&state);
  return jpeg;
}

/// Smooth, with a colour that differs from channel to channel.
Image ramp(glm::ivec2 size) {
  Image image{.size = size};
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      image.pixels.emplace_back(0.8f * float(x) / float(size.x), 0.5f * float(y) / float(size.y), 0.1f, 0.8f);
  return image;
}

TEST(Jpeg, ShowsWhatAPngOverTheSameBackgroundShows) {
  const TemporaryFolder folder;
  const Image image = ramp({61, 47});
  const DisplayLook look{.background = Background{glm::vec3(0.2f), glm::vec3(0.4f)}, .exposure = 0.5};
  writeJpeg(folder / "a.jpg", image, look);
  const Jpeg jpeg = read(readBytes(folder / "a.jpg"));
  ASSERT_EQ(jpeg.size, image.size);
  ASSERT_EQ(jpeg.channels, 3);
  EXPECT_EQ(jpeg.chromaWidth, image.size.x) << "colour is as sharp as brightness";
  const std::vector<std::uint8_t> texels = srgbTexels(image, look);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(jpeg.samples[3 * i + c], texels[4 * i + c], 6) << i << " " << c;
}

TEST(Jpeg, IsOverBlackWithoutABackground) {
  const TemporaryFolder folder;
  Image image{.size = {8, 8}};
  image.pixels.assign(64, glm::vec4(0.0f));
  writeJpeg(folder / "a.jpg", image);
  for (const std::uint8_t sample : read(readBytes(folder / "a.jpg")).samples) EXPECT_LE(sample, 1);
}

TEST(Jpeg, SameImageGivesTheSameBytesAndAnUnwritableFileOneSentence) {
  const TemporaryFolder folder;
  writeJpeg(folder / "a.jpg", ramp({33, 20}));
  writeJpeg(folder / "b.jpg", ramp({33, 20}));
  EXPECT_EQ(readBytes(folder / "a.jpg"), readBytes(folder / "b.jpg"));
  test::expectRefusal([&] { writeJpeg(folder / "none/a.jpg", ramp({4, 4})); }, ErrorKind::Output, {"none/a.jpg"});
}

}  // namespace
}  // namespace freevoxels
