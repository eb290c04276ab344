#include "engine/validation/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "engine/validation/base64.h"
#include "engine/validation/report_text.h"
#include "engine/validation/svg_plot.h"
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
constexpr const char* kHostileEscaped = "a&lt;b &amp; &quot;c&quot; &#39;d&#39; &lt;/script&gt;";

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

std::string htmlOf(const Report& report) {
  const TemporaryFolder folder;
  writeHtml(folder / "report.html", report);
  EXPECT_EQ(folder.fileCount(), 1u);
  return readBytes(folder / "report.html");
}

nlohmann::json jsonOf(const Report& report) {
  const TemporaryFolder folder;
  writeJson(folder / "report.json", report);
  return nlohmann::json::parse(readBytes(folder / "report.json"));
}

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
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

TEST(ReportText, EscapesWhatHtmlWouldRead) {
  EXPECT_EQ(escapeHtml(kHostile), kHostileEscaped);
  EXPECT_EQ(escapeHtml("µ\n\t"), "µ\n\t");
  EXPECT_EQ(escapeHtml(std::string("a\0b\x1b", 4)), "a\uFFFDb\uFFFD");
}

TEST(ReportText, FiguresHaveFourDigitsOrAsManyAsTellThemApart) {
  EXPECT_EQ(figureText(0.123456), "0.1235");
  EXPECT_EQ(figureText(-12.3456), "−12.35");
  EXPECT_EQ(figureText(123456.7), "123457");
  EXPECT_EQ(figureText(0.0000123456), "1.235·10⁻⁵");
  EXPECT_EQ(figureText(1.5e300), "1.500·10³⁰⁰");
  EXPECT_EQ(figureText(0.0), "0");
  EXPECT_EQ(figureText(131072.0), "131072");
  EXPECT_EQ(figureText(kNan), "NaN");
  EXPECT_EQ(figureText(kInfinity), "∞");
  EXPECT_EQ(figureText(-kInfinity), "−∞");
  EXPECT_EQ(figureTextBeside(1.0000001, 1.0), "1.0000001");
  EXPECT_EQ(figureTextBeside(0.10000004, 0.1), "0.10000004");
  EXPECT_EQ(figureTextBeside(0.1, 0.1), "0.1000");
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

TEST(ReportHtml, HasEveryCheckAndTheFailuresOnceMore) {
  const Report report = fullReport();
  const std::string html = htmlOf(report);
  for (const Check& check : report.sections[0].checks) {
    SCOPED_TRACE(check.name);
    const std::string name = escapeHtml(check.name);
    EXPECT_EQ(countOf(html, "<th scope=\"row\">" + name + "</th><td class=\"" +
                                (check.passed() ? "pass\">pass" : "fail\">FAIL")),
              1u);
    EXPECT_EQ(countOf(html, "Table: " + name + "</a>"), check.passed() ? 0u : 1u);
    EXPECT_NE(html.find(escapeHtml(check.where)), std::string::npos);
  }
  EXPECT_NE(html.find("2 of 5 checks failed"), std::string::npos);
  EXPECT_NE(html.find("<td class=\"number\">65.43</td><td class=\"number\">≥ 65</td><td>dB</td>"),
            std::string::npos);
  EXPECT_NE(html.find("<td class=\"number\">1.0000001</td>"), std::string::npos);
}

TEST(ReportHtml, EveryLinkHasItsTarget) {
  const std::string html = htmlOf(fullReport());
  const std::regex link("href=\"#([^\"]*)\"");
  int count = 0;
  for (std::sregex_iterator it(html.begin(), html.end(), link), end; it != end; ++it, ++count)
    EXPECT_EQ(countOf(html, "id=\"" + (*it)[1].str() + "\""), 1u) << (*it)[1];
  EXPECT_EQ(count, 4);  // two sections, two failures
}

TEST(ReportHtml, EscapesEverything) {
  const std::string html = htmlOf(fullReport());
  EXPECT_EQ(html.find(kHostile), std::string::npos);
  EXPECT_EQ(html.find("</script>"), std::string::npos);
  // Fact; check, its failure; cell; label and series of the plot; title, its link; alternative and caption of
  // the image.
  EXPECT_EQ(countOf(html, kHostileEscaped), 10u);
}

TEST(ReportHtml, NeedsNothingElse) {
  const std::string html = htmlOf(fullReport());
  for (const char* reference : {"http:", "https:", "url(", "@import", "<link", "<script"})
    EXPECT_EQ(html.find(reference), std::string::npos) << reference;
  EXPECT_EQ(countOf(html, "src="), 2u);
  EXPECT_EQ(countOf(html, "src=\"data:image/png;base64,"), 2u);
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

TEST(ReportHtml, ImagesAreEmbeddedOverTheirBackground) {
  const Report report = fullReport();
  const ImageRow& row = report.sections[1].imageRows[0];
  const std::string html = htmlOf(report);
  const std::regex source("src=\"data:image/png;base64,([^\"]*)\"");
  const TemporaryFolder folder;
  std::sregex_iterator it(html.begin(), html.end(), source);
  for (const ImageRow::Captioned& shown : row.images) {
    ASSERT_NE(it, std::sregex_iterator());
    test::writeBytes(folder / "embedded.png", decoded((*it++)[1]));
    const Image embedded = readPng(folder / "embedded.png");
    ASSERT_EQ(embedded.size, shown.image.size);
    for (std::size_t i = 0; i < embedded.pixels.size(); ++i) {
      const glm::vec4& pixel = shown.image.pixels[i];
      EXPECT_EQ(embedded.pixels[i].a, 1.0f);
      for (int c = 0; c < 3; ++c)  // a byte of sRGB is at most 0.009 of linear light
        ASSERT_NEAR(embedded.pixels[i][c], pixel[c] + (1.0f - pixel.a) * row.background[c], 0.005f) << i;
    }
  }
  EXPECT_NE(html.find("width=\"255\" height=\"204\""), std::string::npos) << "small images are enlarged";
  EXPECT_NE(html.find("width=\"300\" height=\"2\""), std::string::npos);
}

TEST(ReportFiles, TheSameReportMakesTheSameBytes) {
  EXPECT_EQ(htmlOf(fullReport()), htmlOf(fullReport()));
  EXPECT_EQ(jsonOf(fullReport()), jsonOf(fullReport()));
}

TEST(ReportFiles, AnEmptyReportIsAPageToo) {
  EXPECT_NE(htmlOf({}).find("no checks"), std::string::npos);
  const nlohmann::json json = jsonOf({});
  EXPECT_TRUE(json.at("facts").is_object());
  EXPECT_TRUE(json.at("sections").is_array());
}

TEST(ReportFiles, AFolderThatIsNotThereIsAnErrorOfOutput) {
  const TemporaryFolder folder;
  for (const auto& write : {&writeHtml, &writeJson}) {
    const Error error = test::errorOf([&] { write(folder / "none" / "report", Report{}); });
    EXPECT_EQ(error.kind(), ErrorKind::Output);
    EXPECT_NE(std::string(error.what()).find("none"), std::string::npos);
  }
}

TEST(SvgPlot, TicksAreRoundAndSpanTheData) {
  for (const glm::dvec2 range :
       {glm::dvec2(0.0, 1.0), {-3.2e-7, 4.9e-7}, {99.0, 101.0}, {-1e12, 7e12}, {0.3, 0.9}}) {
    const Ticks ticks = ticksBetween(range.x, range.y, 6);
    const double tolerance = 1e-6 * ticks.step;
    EXPECT_LE(ticks.value(ticks.first), range.x + tolerance);
    EXPECT_GE(ticks.value(ticks.last), range.y - tolerance);
    EXPECT_GT(ticks.value(ticks.first + 1), range.x - tolerance) << "a step too many";
    EXPECT_LT(ticks.value(ticks.last - 1), range.y + tolerance) << "a step too many";
    EXPECT_GE(ticks.last - ticks.first, 3);
    EXPECT_LE(ticks.last - ticks.first, 8);
    const double leading = ticks.step / std::pow(10.0, std::floor(std::log10(ticks.step) + 1e-9));
    EXPECT_TRUE(std::abs(leading - 1) < 1e-9 || std::abs(leading - 2) < 1e-9 || std::abs(leading - 5) < 1e-9)
        << ticks.step;
  }
}

TEST(SvgPlot, DrawsEveryPointAndBreaksLinesWhereThereIsNone) {
  ReportPlot plot{.caption = "c", .xLabel = "x", .yLabel = "y", .series = {}};
  plot.series.push_back({"one", {{0, 0}, {1, 1}, {2, kNan}, {3, 2}, {10, 4}}});
  std::string svg = svgPlot(plot);
  EXPECT_EQ(countOf(svg, "class=\"line\""), 1u);
  EXPECT_EQ(countOf(svg, "<path fill="), 4u);
  // x from 84 to 704 for 0 to 10, y from 314 to 14 for 0 to 4.
  EXPECT_NE(svg.find("d=\"M84.00,314.00L146.00,239.00M270.00,164.00L704.00,14.00\""), std::string::npos)
      << svg;
  EXPECT_EQ(countOf(svg, "class=\"legend\""), 0u);
  plot.series.push_back({"two", {{0, 4}}});
  svg = svgPlot(plot);
  EXPECT_EQ(countOf(svg, "class=\"legend\""), 2u);
  EXPECT_NE(svg.find("#0072B2"), std::string::npos);
  EXPECT_NE(svg.find("#D55E00"), std::string::npos);
}

TEST(SvgPlot, HasNoNumberThatIsNone) {
  const std::vector<std::vector<glm::dvec2>> cases = {{},
                                                      {{kNan, kNan}},
                                                      {{0, 0}},
                                                      {{5, 7}},
                                                      {{1, 1e308}, {2, -1e308}},
                                                      {{0, 1e-310}, {0, 2e-310}},
                                                      {{1e300, -1e300}, {-1e300, 1e300}}};
  for (const std::vector<glm::dvec2>& points : cases) {
    ReportPlot plot{.caption = "c", .xLabel = "x", .yLabel = "y", .series = {{"s", points}}};
    const std::string svg = svgPlot(plot);
    EXPECT_EQ(svg.find("nan"), std::string::npos) << svg;
    EXPECT_EQ(svg.find("inf"), std::string::npos) << svg;
    EXPECT_LT(svg.size(), 20000u);
  }
}

}  // namespace
}  // namespace freevoxels
