#include "engine/validation/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/validation/base64.h"
#include "tests/not_finite.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::kInfinity;
using test::kNan;
using test::readBytes;
using test::TemporaryFolder;

constexpr const char* kHostile = "a<b & \"c\" 'd' </script>";

Image pattern(glm::ivec2 size, int seed) {
  Image image;
  image.size = size;
  for (int i = 0; i < size.x * size.y; ++i) {
    const float alpha = float((i * 7 + seed) % 5) / 4.0f;
    image.pixels.emplace_back(alpha * glm::vec3(float(i % 3) / 2.0f, 0.25f, float(seed) / 3.0f), alpha);
  }
  return image;
}

Report fullReport() {
  Report report;
  report.facts = {{"device", "llvmpipe"}, {"volume", kHostile}};
  ReportSection table{.title = "Table", .text = "First.\n\nSecond.", .checks = {}, .tables = {}, .plots = {}, .imageRows = {}};
  table.checks = {
      {.name = "codes apart", .figure = 1.0, .tolerance = 1.0, .unit = "codes", .where = "voxel 3,4,5"},
      {.name = "PSNR", .figure = 65.4321, .bound = Check::Bound::AtLeast, .tolerance = 65.0, .unit = "dB", .where = ""},
      {.name = "equal images", .figure = kInfinity, .bound = Check::Bound::AtLeast, .tolerance = 65.0, .unit = "dB", .where = ""},
      {.name = "by a hair", .figure = 1.0000001, .tolerance = 1.0, .unit = "", .where = "pixel 7,8"},
      {.name = kHostile, .figure = kNan, .tolerance = 0.1, .unit = "", .where = ""}};
  table.tables.push_back({.caption = "By direction",
                          .columns = {"direction", "largest"},
                          .rows = {{kHostile, "0.5"}, {"+x", "12"}}});
  ReportSection rows{.title = kHostile, .text = "", .checks = {}, .tables = {}, .plots = {}, .imageRows = {}};
  rows.plots.push_back(
      {.caption = "Error",
       .xLabel = "resolution",
       .yLabel = kHostile,
       .series = {{"ours", {{16.0, 0.1}, {32.0, kNan}, {64.0, 1.0 / 3.0}}}, {kHostile, {{16.0, -1e-7}, {64.0, kInfinity}}}}});
  rows.imageRows.push_back({.caption = "Side by side",
                            .images = {{kHostile, pattern({5, 4}, 1)}, {"right", pattern({300, 2}, 2)}},
                            .background = {0.2f, 0.0f, 0.6f}});
  report.sections = {table, rows};
  return report;
}

nlohmann::json jsonOf(const Report& report) {
  const TemporaryFolder folder;
  writeJson(folder / "report.json", report);
  return nlohmann::json::parse(readBytes(folder / "report.json"));
}

Report reportOf(const Check& check) {
  Report report;
  report.sections.push_back({.title = "Only", .text = "", .checks = {check}, .tables = {}, .plots = {}, .imageRows = {}});
  return report;
}

TEST(ReportVerdict, IsOfTheFigureAndItsBound) {
  const auto passes = [](double figure, Check::Bound bound, double tolerance) {
    const Check check{
        .name = "", .figure = figure, .bound = bound, .tolerance = tolerance, .unit = "", .where = ""};
    EXPECT_EQ(reportOf(check).passed(), check.passed());
    EXPECT_EQ(reportOf(check).failures(), check.passed() ? 0u : 1u);
    return check.passed();
  };
  using enum Check::Bound;
  EXPECT_TRUE(passes(1.0, AtMost, 1.0));
  EXPECT_FALSE(passes(std::nextafter(1.0, 2.0), AtMost, 1.0));
  EXPECT_TRUE(passes(1.0, AtLeast, 1.0));
  EXPECT_FALSE(passes(std::nextafter(1.0, 0.0), AtLeast, 1.0));
  EXPECT_TRUE(passes(kInfinity, AtLeast, 60.0));
  EXPECT_FALSE(passes(kInfinity, AtMost, 60.0));
  for (const auto bound : {AtMost, AtLeast})
    for (const double tolerance : {0.0, kInfinity, -kInfinity, kNan})
      EXPECT_FALSE(passes(kNan, bound, tolerance));
}

TEST(ReportVerdict, OneFailureFailsTheReport) {
  Report report = fullReport();
  EXPECT_FALSE(report.passed());
  EXPECT_EQ(report.checkCount(), 5u);
  EXPECT_EQ(report.failures(), 2u);
  EXPECT_FALSE(report.sections[0].passed());
  EXPECT_TRUE(report.sections[1].passed());
  report.sections[0].checks.resize(3);
  EXPECT_TRUE(report.passed());
}

TEST(Base64, IsThatOfTheRfc) {
  const auto encoded = [](std::string_view text) {
    return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  for (const auto& [text, expected] : std::map<std::string, std::string>{{"", ""},
                                                                         {"f", "Zg=="},
                                                                         {"fo", "Zm8="},
                                                                         {"foo", "Zm9v"},
                                                                         {"foob", "Zm9vYg=="},
                                                                         {"fooba", "Zm9vYmE="},
                                                                         {"foobar", "Zm9vYmFy"},
                                                                         {"\xfb\xff\xfe", "+//+"}})
    EXPECT_EQ(encoded(text), expected);
}

TEST(ReportJson, ReadsBackWithTheSameFigures) {
  const Report report = fullReport();
  const nlohmann::json json = jsonOf(report);
  EXPECT_EQ(json.at("passed"), false);
  EXPECT_EQ(json.at("checks"), 5);
  EXPECT_EQ(json.at("failed"), 2);
  EXPECT_EQ(json.at("facts").at("volume"), kHostile);
  ASSERT_EQ(json.at("sections").size(), 2u);
  const nlohmann::json& section = json["sections"][0];
  EXPECT_EQ(section.at("title"), "Table");
  EXPECT_EQ(section.at("text"), "First.\n\nSecond.");
  EXPECT_EQ(section.at("passed"), false);
  for (const std::size_t i : {0u, 1u, 3u}) {
    const Check& check = report.sections[0].checks[i];
    EXPECT_EQ(section.at("checks")[i].at("figure").get<double>(), check.figure);
    EXPECT_EQ(section["checks"][i].at("tolerance").get<double>(), check.tolerance);
    EXPECT_EQ(section["checks"][i].at("name"), check.name);
    EXPECT_EQ(section["checks"][i].at("where"), check.where);
    EXPECT_EQ(section["checks"][i].at("unit"), check.unit);
    EXPECT_EQ(section["checks"][i].at("passed"), check.passed());
  }
  EXPECT_EQ(section["checks"][0].at("bound"), "at most");
  EXPECT_EQ(section["checks"][1].at("bound"), "at least");
  EXPECT_EQ(section["checks"][2].at("figure"), "Infinity");
  EXPECT_EQ(section["checks"][4].at("figure"), "NaN");
  EXPECT_EQ(section["checks"][4].at("passed"), false);
  EXPECT_EQ(section.at("tables")[0].at("columns"), (std::vector<std::string>{"direction", "largest"}));
  EXPECT_EQ(section["tables"][0].at("rows")[1], (std::vector<std::string>{"+x", "12"}));
}

TEST(ReportJson, HasPlotsAndTheSizesOfImages) {
  const nlohmann::json section = jsonOf(fullReport()).at("sections").at(1);
  const nlohmann::json& plot = section.at("plots").at(0);
  EXPECT_EQ(plot.at("x_label"), "resolution");
  EXPECT_EQ(plot.at("series")[0].at("name"), "ours");
  EXPECT_EQ(plot["series"][0].at("points")[2][1].get<double>(), 1.0 / 3.0);
  EXPECT_EQ(plot["series"][0]["points"][1], (nlohmann::json{32.0, "NaN"}));
  EXPECT_EQ(plot["series"][1]["points"][0][1].get<double>(), -1e-7);
  const nlohmann::json& row = section.at("image_rows").at(0);
  EXPECT_EQ(row.at("caption"), "Side by side");
  EXPECT_EQ(row.at("images")[1].at("caption"), "right");
  EXPECT_EQ(row["images"][1].at("width"), 300);
  EXPECT_EQ(row["images"][1].at("height"), 2);
}

std::string decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | std::uint32_t(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += char(bits >> count & 255u);
  }
  return bytes;
}

TEST(ReportJson, HasImagesOverTheirBackground) {
  const Report report = fullReport();
  const ImageRow& row = report.sections[1].imageRows[0];
  const nlohmann::json images = jsonOf(report).at("sections").at(1).at("image_rows").at(0).at("images");
  const TemporaryFolder folder;
  for (std::size_t n = 0; n < row.images.size(); ++n) {
    const Image& shown = row.images[n].image;
    test::writeBytes(folder / "embedded.png", decoded(images[n].at("png")));
    const Image embedded = readPng(folder / "embedded.png");
    ASSERT_EQ(embedded.size, shown.size);
    for (std::size_t i = 0; i < embedded.pixels.size(); ++i) {
      const glm::vec4& pixel = shown.pixels[i];
      EXPECT_EQ(embedded.pixels[i].a, 1.0f);
      for (int c = 0; c < 3; ++c)  // a byte of sRGB is at most 0.009 of linear light
        ASSERT_NEAR(embedded.pixels[i][c], pixel[c] + (1.0f - pixel.a) * row.background[c], 0.005f) << i;
    }
  }
}

TEST(ReportJson, OfAnEmptyReportIsWhole) {
  const nlohmann::json json = jsonOf({});
  EXPECT_TRUE(json.at("facts").is_object());
  EXPECT_TRUE(json.at("sections").is_array());
}

TEST(ReportJson, InAFolderThatIsNotThereIsAnErrorOfOutput) {
  const TemporaryFolder folder;
  const Error error = test::errorOf([&] { writeJson(folder / "none" / "report", Report{}); });
  EXPECT_EQ(error.kind(), ErrorKind::Output);
  EXPECT_NE(std::string(error.what()).find("none"), std::string::npos);
}

}  // namespace
}  // namespace freevoxels
