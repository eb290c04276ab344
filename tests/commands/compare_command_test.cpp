// freevoxels compare.

#include <limits>
#include <nlohmann/json.hpp>

#include "engine/image/image.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

class CompareCommand : public CommandTest {
 protected:
  void write(const std::string& name, glm::vec4 pixel, glm::ivec2 size = {24, 16}) const {
    const Image image{size, std::vector<glm::vec4>(std::size_t(size.x * size.y), pixel), {}};
    if (name.ends_with(".exr"))
      writeExr(folder / name, image, {.fullFloat = true});
    else
      writePng(folder / name, image);
  }
  nlohmann::json compare(const std::string& text) const {
    const ProgramResult result = run("compare --json " + text);
    expectSuccess(result);
    return nlohmann::json::parse(result.out);
  }
};

}  // namespace

/// libpng takes memory for rows of the width that the header says.
TEST_F(CompareCommand, AnImageThatClaimsMoreThanItsFileHoldsIsRefusedAtOnce) {
  write("a.png", {0.6f, 0.5f, 0.5f, 1.0f});
  std::string bytes = readBytes(folder / "a.png");
  for (const std::string& size : {std::string("\x1f\0\0\0\0\0\0\x01", 8), std::string("\0\0\x7f\0\0\0\x7f\0", 8), std::string("\0\0\0\x01\x0f\0\0\0", 8)}) {
    bytes.replace(16, size.size(), size);
    std::uint32_t check = ~0u;  // of the chunk: CRC-32
    for (const char byte : bytes.substr(12, 17)) {
      check ^= static_cast<unsigned char>(byte);
      for (int bit = 0; bit < 8; ++bit) check = check >> 1 ^ (check & 1u ? 0xedb88320u : 0u);
    }
    for (int i = 0; i < 4; ++i) bytes[29 + std::size_t(i)] = char(~check >> (24 - 8 * i));
    writeBytes(folder / "b.png", bytes);
    const ProgramResult result = run("compare @b.png @b.png");
    expectRefusal(result, ExitCode::Input, "cannot hold");
    EXPECT_LT(result.peakBytes, std::uint64_t(300) << 20);
  }
}

TEST_F(CompareCommand, MeasuresAsJsonAndAsATable) {
  write("a.exr", {0.6f, 0.5f, 0.5f, 1.0f});
  write("b.exr", {0.5f, 0.5f, 0.5f, 1.0f});
  const auto json = compare("@a.exr @b.exr");
  EXPECT_EQ(json.at("size"), (nlohmann::json{24, 16}));
  EXPECT_EQ(json.at("channels"), "RGB");
  EXPECT_NEAR(json.at("rmse"), 0.1 / std::sqrt(3.0), 1e-7);
  EXPECT_NEAR(json.at("psnr"), 20.0 + 10.0 * std::log10(3.0), 1e-5);
  EXPECT_NEAR(json.at("maximum").at("difference"), 0.1, 1e-7);
  EXPECT_EQ(json.at("maximum").at("pixel"), (nlohmann::json{0, 0}));
  EXPECT_EQ(json.at("maximum").at("channel"), "R");
  EXPECT_GT(json.at("ldr_flip"), 0.01);
  EXPECT_GT(json.at("hdr_flip"), 0.01);
  EXPECT_EQ(json.at("exposures").at("count"), 2);

  const ProgramResult table = run("compare @a.exr @b.exr");
  expectSuccess(table);
  EXPECT_EQ(table.err, "");
  for (const char* word :
       {"RMSE", "0.057735", "PSNR", "24.77", "pixel (0, 0), channel R", "LDR-FLIP", "HDR-FLIP"})
    EXPECT_NE(table.out.find(word), std::string::npos) << word << "\n" << table.out;
}

TEST_F(CompareCommand, EqualImagesAreEqualInEitherFormat) {
  write("a.exr", {0.5f, 0.25f, 0.0f, 0.5f});
  write("b.png", {1.0f, 0.0f, 1.0f, 1.0f});
  write("c.exr", {1.0f, 0.0f, 1.0f, 1.0f});
  for (const char* pair : {"@a.exr @a.exr", "@b.png @c.exr", "@c.exr @b.png"}) {
    const auto json = compare(pair);
    EXPECT_EQ(json.at("rmse"), 0.0);
    EXPECT_TRUE(json.at("psnr").is_null());
    EXPECT_EQ(json.at("ldr_flip"), 0.0);
    EXPECT_EQ(json.at("hdr_flip"), 0.0);
  }
  expectSuccess(
      run("compare @a.exr @a.exr --fail-above psnr=300 --fail-above rmse=0 --fail-above hdr-flip=0"));
}

TEST_F(CompareCommand, TheSecondImageIsTheReference) {
  write("dim.exr", {0.01f, 0.01f, 0.01f, 1.0f});
  write("bright.exr", {10.0f, 10.0f, 10.0f, 1.0f});
  const double ofBright = compare("@dim.exr @bright.exr").at("exposures").at("start");
  const double ofDim = compare("@bright.exr @dim.exr").at("exposures").at("start");
  EXPECT_NEAR(ofDim - ofBright, std::log2(1000.0), 1e-4);
}

TEST_F(CompareCommand, LimitsSetTheExitCode) {
  write("a.exr", {0.6f, 0.6f, 0.6f, 1.0f});
  write("b.exr", {0.5f, 0.5f, 0.5f, 1.0f});  // RMSE 0.1, PSNR 20 dB
  expectSuccess(run("compare @a.exr @b.exr --fail-above RMSE=0.11 --fail-above psnr=19.9"));
  const ProgramResult above = run("compare --fail-above rmse=0.09 --fail-above maximum=1 @a.exr @b.exr");
  EXPECT_EQ(above.exitCode, int(ExitCode::Comparison));
  EXPECT_NE(above.out.find("HDR-FLIP"), std::string::npos) << "the table is printed all the same";
  EXPECT_NE(above.err.find("rmse 0.1 is above 0.09"), std::string::npos) << above.err;
  EXPECT_EQ(above.err.find("maximum"), std::string::npos) << above.err;
  const ProgramResult below = run("compare --fail-above PSNR=20.1 @a.exr @b.exr");
  EXPECT_EQ(below.exitCode, int(ExitCode::Comparison));
  EXPECT_NE(below.err.find("psnr 20 is below 20.1"), std::string::npos) << below.err;
  for (const char* flip : {"ldr-flip", "hdr-flip"}) {
    const std::string command = std::string("compare @a.exr @b.exr --fail-above ") + flip;
    expectSuccess(run(command + "=1"));
    EXPECT_EQ(run(command + "=0.001").exitCode, int(ExitCode::Comparison));
  }
}

TEST_F(CompareCommand, BackgroundIsWhatFlipSeesThroughAlpha) {
  // Over white, black of alpha 0.5 is grey and an empty pixel white; over black both are black.
  write("a.exr", {0.0f, 0.0f, 0.0f, 0.5f});
  write("b.exr", {0.0f, 0.0f, 0.0f, 0.0f});
  EXPECT_EQ(compare("@a.exr @b.exr").at("ldr_flip"), 0.0);
  EXPECT_GT(compare("@a.exr @b.exr").at("rmse"), 0.2);
  EXPECT_GT(compare("@a.exr @b.exr --background 1,1,1").at("ldr_flip"), 0.2);
}

TEST_F(CompareCommand, ViewingDistanceAndExposuresCanBeChosen) {
  write("a.exr", {0.6f, 0.5f, 0.5f, 1.0f});
  write("b.exr", {0.5f, 0.5f, 0.5f, 1.0f});
  const auto json = compare("@a.exr @b.exr --exposures -2,4.5 --ppd 20");
  EXPECT_EQ(json.at("exposures").at("start"), -2.0);
  EXPECT_EQ(json.at("exposures").at("stop"), 4.5);
  EXPECT_EQ(json.at("exposures").at("count"), 7);
}

TEST_F(CompareCommand, WritesTheDifference) {
  write("a.exr", {0.75f, 0.25f, 0.5f, 1.0f});
  write("b.exr", {0.5f, 0.5f, 0.5f, 1.0f});
  expectSuccess(run("compare @a.exr @b.exr --difference @d.exr"));
  for (const glm::vec4& pixel : readExr(folder / "d.exr").pixels)
    ASSERT_EQ(pixel, glm::vec4(0.25f, 0.25f, 0.0f, 0.0f));
  expectSuccess(run("compare @a.exr @b.exr --difference @d.png"));
  const Image map = readPng(folder / "d.png");
  EXPECT_EQ(map.size, glm::ivec2(24, 16));
  EXPECT_GT(map.pixels[100].r, 0.05f);
  expectSuccess(run("compare @a.exr @a.exr --difference @same.png"));
  for (const glm::vec4& pixel : readPng(folder / "same.png").pixels) ASSERT_LT(pixel.r + pixel.g, 0.001f);
  // It is written also where a limit is broken: that is when it is wanted.
  EXPECT_EQ(run("compare @a.exr @b.exr --difference @f.png --fail-above rmse=0").exitCode, 7);
  EXPECT_TRUE(std::filesystem::exists(folder / "f.png"));
}

TEST_F(CompareCommand, RefusesImagesThatDoNotCompare) {
  write("a.exr", {0.5f, 0.5f, 0.5f, 1.0f});
  write("wide.exr", {0.5f, 0.5f, 0.5f, 1.0f}, {25, 16});
  write("nan.exr", {0.5f, std::numeric_limits<float>::quiet_NaN(), 0.5f, 1.0f});
  writeBytes(folder / "text.png", "this is no image");
  writeBytes(folder / "short.exr", readBytes(folder / "a.exr").substr(0, 200));
  expectCleanRefusal("compare @a.exr @wide.exr", ExitCode::Input, "24x16");
  expectCleanRefusal("compare @a.exr @nan.exr", ExitCode::Input, "nan.exr': channel G of pixel (0, 0)");
  expectCleanRefusal("compare @nan.exr @a.exr --difference @d.png", ExitCode::Input, "nan.exr");
  expectCleanRefusal("compare @a.exr @none.exr", ExitCode::Input, "none.exr");
  expectCleanRefusal("compare @text.png @a.exr", ExitCode::Input, "text.png");
  expectCleanRefusal("compare @short.exr @a.exr", ExitCode::Input, "short.exr");
}

TEST_F(CompareCommand, RefusesWrongUse) {
  write("a.exr", {0.5f, 0.5f, 0.5f, 1.0f});
  for (const auto& [arguments, mention] : {std::pair{"", "A"},
                                           {"--fail-above ssim=1", "ssim"},
                                           {"--fail-above rmse", "rmse"},
                                           {"--fail-above rmse=", "rmse="},
                                           {"--fail-above rmse=nan", "rmse=nan"},
                                           {"--fail-above rmse=1x", "rmse=1x"},
                                           {"--ppd 0", "--ppd"},
                                           {"--background 1,2", "--background"},
                                           {"--exposures 2,1", "--exposures"},
                                           {"--difference @d.jpg", "d.jpg"},
                                           {"--difference @a.exr", "a.exr"}})
    expectCleanRefusal(std::string("compare ") + (*arguments ? "@a.exr @a.exr " : "") + arguments,
                       ExitCode::Usage, mention);
  expectCleanRefusal("compare @a.exr @a.exr --difference @none/d.png", ExitCode::Output, "none");
}

}  // namespace freevoxels::test
