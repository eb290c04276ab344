#include "apps/freevoxels/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "apps/common/output_options.h"
#include "apps/common/program.h"
#include "apps/common/text_table.h"
#include "engine/core/error.h"
#include "engine/image/flip.h"
#include "engine/image/metrics.h"

namespace freevoxels {

namespace {

constexpr std::string_view kChannels = "RGBA";

struct Comparison {
  glm::ivec2 size{0};
  ImageMetrics metrics;
  Exposures exposures;
  double ldrFlip = 0.0, hdrFlip = 0.0;  ///< means of the maps
  FlipMap ldrMap;
};

struct MetricName {
  const char* name;
  double (*value)(const Comparison&);
  bool moreIsBetter = false;
};

constexpr std::array<MetricName, 5> kMetrics{{
    {"rmse", [](const Comparison& c) { return c.metrics.rmse; }},
    {"psnr", [](const Comparison& c) { return c.metrics.psnr; }, true},
    {"maximum", [](const Comparison& c) { return c.metrics.maximum; }},
    {"ldr-flip", [](const Comparison& c) { return c.ldrFlip; }},
    {"hdr-flip", [](const Comparison& c) { return c.hdrFlip; }},
}};

/// "METRIC=VALUE"
struct Limit {
  const MetricName* metric;
  double value;

  bool isBroken(const Comparison& comparison) const {
    const double measured = metric->value(comparison);
    return metric->moreIsBetter ? measured < value : measured > value;
  }
};

Limit parseLimit(const std::string& text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  std::string name = text.substr(0, equals);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  const auto metric = std::ranges::find_if(kMetrics, [&](const MetricName& m) { return m.name == name; });
  if (metric == kMetrics.end())
    fail(ErrorKind::Usage, "--fail-above knows rmse, psnr, maximum, ldr-flip and hdr-flip, not '{}'", text);
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const char* const begin = std::min(text.data() + equals + 1, end);
  const auto parsed = std::from_chars(begin, end, value);
  if (begin == end || parsed.ptr != end || parsed.ec != std::errc() || !std::isfinite(value))
    fail(ErrorKind::Usage, "--fail-above takes METRIC=VALUE with a finite number, not '{}'", text);
  return {&*metric, value};
}

Image readFinite(const std::string& file) {
  Image image = readImage(file);
  if (const auto bad = findNonFinite(image))
    fail(ErrorKind::Input,
         "cannot compare '{}': channel {} of pixel ({}, {}) is NaN or infinite; render it again", file,
         kChannels[std::size_t(bad->channel)], bad->pixel.x, bad->pixel.y);
  return image;
}

std::string psnrText(double psnr) {
  return std::isinf(psnr) ? "infinite" : fmt::format("{:.2f}", psnr);
}

void printTable(const Comparison& comparison) {
  using enum TextTable::Align;
  const ImagePosition& where = comparison.metrics.where;
  const Exposures& exposures = comparison.exposures;
  const TextTable table{
      .columns = {Left, Right, Left},
      .rows = {{"METRIC", "VALUE", ""},
               {"RMSE", fmt::format("{:.6g}", comparison.metrics.rmse),
                comparison.metrics.countsAlpha ? "premultiplied RGBA" : "RGB, both are opaque"},
               {"PSNR", psnrText(comparison.metrics.psnr), "dB for a peak of 1"},
               {"maximum", fmt::format("{:.6g}", comparison.metrics.maximum),
                comparison.metrics.maximum > 0.0
                    ? fmt::format("pixel ({}, {}), channel {}", where.pixel.x, where.pixel.y,
                                  kChannels[std::size_t(where.channel)])
                    : "the images are equal"},
               {"LDR-FLIP", fmt::format("{:.6f}", comparison.ldrFlip), "mean"},
               {"HDR-FLIP", fmt::format("{:.6f}", comparison.hdrFlip),
                fmt::format("mean, {} exposures from {:+.2f} to {:+.2f} stops", exposures.count,
                            exposures.start, exposures.stop)}}};
  for (const std::string& line : table.lines()) fmt::print("{}\n", line);
}

nlohmann::ordered_json toJson(const Comparison& comparison) {
  const ImageMetrics& metrics = comparison.metrics;
  nlohmann::ordered_json json;
  json["size"] = {comparison.size.x, comparison.size.y};
  json["channels"] = metrics.countsAlpha ? "RGBA" : "RGB";
  json["rmse"] = metrics.rmse;
  json["psnr"] = nullptr;
  if (std::isfinite(metrics.psnr)) json["psnr"] = metrics.psnr;
  json["maximum"] = {{"difference", metrics.maximum},
                     {"pixel", {metrics.where.pixel.x, metrics.where.pixel.y}},
                     {"channel", std::string(1, kChannels[std::size_t(metrics.where.channel)])}};
  json["ldr_flip"] = comparison.ldrFlip;
  json["hdr_flip"] = comparison.hdrFlip;
  json["exposures"] = {{"start", comparison.exposures.start},
                       {"stop", comparison.exposures.stop},
                       {"count", comparison.exposures.count}};
  return json;
}

Comparison compare(const Image& test, const Image& reference, glm::vec3 background, double pixelsPerDegree,
                   const std::optional<glm::dvec2>& range) {
  const Image shownTest = compositeOver(test, background);
  const Image shownReference = compositeOver(reference, background);
  Comparison comparison;
  comparison.size = test.size;
  comparison.metrics = compareImages(test, reference);
  comparison.exposures = range ? exposuresBetween(range->x, range->y) : flipExposures(shownReference);
  comparison.ldrMap = ldrFlip(shownTest, shownReference, pixelsPerDegree);
  comparison.ldrFlip = comparison.ldrMap.mean();
  comparison.hdrFlip = hdrFlip(shownTest, shownReference, comparison.exposures, pixelsPerDegree).mean();
  return comparison;
}

void checkLimits(const Comparison& comparison, const std::vector<Limit>& limits, const std::string& test,
                 const std::string& reference) {
  std::vector<std::string> broken;
  for (const Limit& limit : limits)
    if (limit.isBroken(comparison))
      broken.push_back(fmt::format("{} {:.6g} is {} {}", limit.metric->name, limit.metric->value(comparison),
                                   limit.metric->moreIsBetter ? "below" : "above", limit.value));
  if (!broken.empty())
    fail(ErrorKind::Comparison, "'{}' is too far from '{}': {}", test, reference, fmt::join(broken, ", "));
}

void writeDifference(const std::string& file, const Image& test, const Image& reference, const FlipMap& map) {
  const DeferredInterrupts wholeFiles;
  if (isExr(file))
    writeExr(file, absoluteDifference(test, reference), {.fullFloat = true});
  else
    writePng(file, magmaImage(map));
}

}  // namespace

void CompareCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("compare", "Measure the difference between an image and a reference");
  command->add_option("A", test_, "Image to measure: .exr or .png")->required();
  command->add_option("B", reference_, "Reference image of the same size: .exr or .png")->required();
  addText(*command, "--difference", "OUT", difference_,
          "Image to write: .png (LDR-FLIP map, black: equal, yellow: 1) or .exr (|A - B|)");
  command
      ->add_option("--fail-above", limits_,
                   "Exit with code 7 if rmse, maximum, ldr-flip or hdr-flip is above VALUE, or psnr below it; may be repeated")
      ->allow_extra_args(false)
      ->type_name("METRIC=VALUE");
  addTriple(*command, "--background", "R,G,B", background_,
            "Background of both images for FLIP, linear [0,0,0]", {0.0, 1.0});
  addNumber(*command, "--ppd", "N", pixelsPerDegree_,
            "Pixels per degree of the observer's view, for FLIP [67.02]", {1.0, 1000.0});
  addPair(*command, "--exposures", "START,STOP", exposures_, "Exposure range of HDR-FLIP in stops [from B]",
          {-100.0, 100.0});
  command->add_flag("--json", json_, "Print JSON for programs");
  command->footer(
      "RMSE, PSNR and maximum are of premultiplied linear colour and alpha, without alpha if both images\n"
      "are opaque. FLIP compares the images over the background, from 0 (equal) to 1. The exposures of\n"
      "HDR-FLIP range from one for B's brightest pixel to one for its median.\n"
      "Examples:\n"
      "  freevoxels compare cloud.exr truth.exr --difference difference.png\n"
      "  freevoxels compare a.png b.png --fail-above psnr=40 --fail-above ldr-flip=0.02 --json\n");
  command->callback([this] { run(); });
}

void CompareCommand::run() const {
  std::vector<Limit> limits;
  for (const std::string& text : limits_) limits.push_back(parseLimit(text));
  if (exposures_ && exposures_->x > exposures_->y)
    fail(ErrorKind::Usage, "--exposures START,STOP must not end before it starts");
  if (difference_) {
    if (!isExr(*difference_) && !isPng(*difference_))
      fail(ErrorKind::Usage, "'{}' has no known image extension; name it .exr or .png", *difference_);
    checkDistinct({test_, *difference_});
    checkDistinct({reference_, *difference_});
    checkOutput(*difference_);
  }
  const Image test = readFinite(test_), reference = readFinite(reference_);
  if (test.size != reference.size)
    fail(ErrorKind::Input, "'{}' has {}x{} pixels, '{}' {}x{}: only images of the same size compare", test_,
         test.size.x, test.size.y, reference_, reference.size.x, reference.size.y);
  const Comparison comparison = compare(test, reference, background_.value_or(glm::dvec3(0.0)),
                                        pixelsPerDegree_.value_or(kDefaultPixelsPerDegree), exposures_);
  if (difference_) writeDifference(*difference_, test, reference, comparison.ldrMap);
  if (json_)
    fmt::print("{}\n", toJson(comparison).dump(2));
  else
    printTable(comparison);
  checkLimits(comparison, limits, test_, reference_);
}

}  // namespace freevoxels
