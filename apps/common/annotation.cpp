#include "apps/common/annotation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "apps/common/image_text.h"
#include "engine/image/srgb.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

constexpr std::size_t kMaxValues = 5;
constexpr const char* kMinus = "\u2212";

/// A rectangle in pixels.
struct Area {
  glm::dvec2 low{0.0}, high{0.0};
};

/// Lengths in pixels, by the size of the part of the image that is kept.
struct Layout {
  Area part;
  double em = 0.0, gap = 0.0;
  double line = 0.0;  ///< width of lines

  explicit Layout(const PixelRectangle& kept) : part{glm::dvec2(kept.corner), glm::dvec2(kept.corner + kept.size)} {
    constexpr double kMinEm = 10.0, kEmsAlongEdge = 36.0, kLinesAlongEm = 14.0;
    em = std::max(double(std::min(kept.size.x, kept.size.y)) / kEmsAlongEdge, kMinEm);
    gap = std::round(em);
    line = std::max(1.0, std::round(em / kLinesAlongEm));
  }
};

/// White over what is dark on average, and black over what is bright, when the image is shown over its background.
Ink inkOver(const Image& image, const std::optional<Background>& behind, const Area& area) {
  constexpr float kMiddle = 0.4f;  // white with its outline is read over most colours
  const glm::ivec2 low = glm::max(glm::ivec2(area.low), glm::ivec2(0)), high = glm::min(glm::ivec2(area.high), image.size);
  double sum = 0.0, count = 0.0;
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x, ++count) {
      const glm::vec4& pixel = image.pixels[std::size_t(y) * std::size_t(image.size.x) + std::size_t(x)];
      const glm::vec3 back = behind ? glm::mix(behind->top, behind->bottom, (float(y) + 0.5f) / float(image.size.y)) : glm::vec3(0.0f);
      const glm::vec3 shown = glm::vec3(pixel) + std::max(1.0f - pixel.a, 0.0f) * back;
      sum += double(glm::dot(glm::min(shown, 1.0f), glm::vec3(kLuminance)));
    }
  const bool isBright = count > 0.0 && sum > kMiddle * count;
  return isBright ? Ink{glm::vec3(0.0f), glm::vec3(1.0f)} : Ink{};
}

/// A value with as many decimals as its step has.
std::string valueText(double value, double step) {
  constexpr double kLongest = 1e6, kSmallest = 1e-4;
  if (std::abs(value) < 1e-9 * step) value = 0.0;
  std::string text = fmt::format("{:.6g}", value);
  if (std::abs(value) < kLongest && step >= kSmallest) {
    int decimals = std::max(0, -int(std::floor(std::log10(step) + 1e-9)));
    const double scaled = step * std::pow(10.0, decimals);
    if (std::abs(scaled - std::round(scaled)) > 1e-6) ++decimals;  // of 2.5
    text = fmt::format("{:.{}f}", value, decimals);
  }
  return text.starts_with('-') ? kMinus + text.substr(1) : text;
}

/// The unit of the values of a transfer function; empty if it is not known.
std::string valueUnit(const SceneDescription& description, const Volume& volume) {
  if (!volume.valueUnit.empty()) return volume.valueUnit;
  const auto& function = description.classification.transferFunction;
  const TransferPreset* const preset = function && transferFile(*function).empty() ? presetNamed(*function) : nullptr;
  return preset != nullptr && preset->name.starts_with("ct-") ? "HU" : "";
}

bool hasColorBar(const SceneDescription& description, const Scene& scene) {
  const auto& function = scene.classification.transferFunction;
  if (!function || description.classification.iso) return false;
  return std::min(function->opacity.front().scalar, function->color.front().scalar) <
         std::max(function->opacity.back().scalar, function->color.back().scalar);
}

/// The colours of a function from its least value, at the bottom, to its largest one. Projections show them with their opacities.
void drawColors(Image& image, const Classification& classification, bool hasOpacity, const Area& bar, double low, double high) {
  const glm::ivec2 first = glm::max(glm::ivec2(bar.low), glm::ivec2(0)), end = glm::min(glm::ivec2(bar.high), image.size);
  for (int y = first.y; y < end.y; ++y) {
    const double value = std::lerp(high, low, (y + 0.5 - bar.low.y) / (bar.high.y - bar.low.y));
    const ClassifiedVoxel shown = classify(classification, float(value));
    const double opacity = hasOpacity ? -std::expm1(-shown.extinction * classification.transferFunction->unitDistance) : 1.0;
    const glm::vec4 color(opacity * glm::dvec4(shown.color, 1.0));
    for (int x = first.x; x < end.x; ++x) image.pixels[std::size_t(y) * std::size_t(image.size.x) + std::size_t(x)] = color;
  }
}

/// Four lines around an area.
void drawFrame(Image& image, const Area& area, double width, glm::vec3 color) {
  const auto [low, high] = std::pair(area.low - width, area.high + width);
  fillRectangle(image, low, {high.x, area.low.y}, color);
  fillRectangle(image, {low.x, area.high.y}, high, color);
  fillRectangle(image, {low.x, area.low.y}, {area.low.x, area.high.y}, color);
  fillRectangle(image, {area.high.x, area.low.y}, {high.x, area.high.y}, color);
}

void drawColorBar(Image& image, const Classification& classification, bool hasOpacity, const std::string& unit,
                  const std::optional<Background>& behind, const Layout& layout) {
  constexpr double kShareOfHeight = 0.5, kLabels = 5.0;  // width that labels take, in ems
  const TransferFunction& function = *classification.transferFunction;
  const double low = std::min(function.opacity.front().scalar, function.color.front().scalar),
               high = std::max(function.opacity.back().scalar, function.color.back().scalar);
  const glm::dvec2 size(std::round(0.9 * layout.em), std::round(kShareOfHeight * (layout.part.high.y - layout.part.low.y)));
  const double right = layout.part.high.x - layout.gap, top = std::round(0.5 * (layout.part.low.y + layout.part.high.y - size.y));
  const Area bar{{right - size.x, top}, {right, top + size.y}};
  const Ink ink = inkOver(image, behind, {{bar.low.x - kLabels * layout.em, bar.low.y}, {bar.low.x, bar.high.y}});
  drawFrame(image, bar, 2.0 * layout.line, ink.outline);
  drawFrame(image, bar, layout.line, ink.fill);
  drawColors(image, classification, hasOpacity, bar, low, high);
  const std::vector<double> values = roundValues(low, high);
  const double tick = std::round(0.4 * layout.em);
  for (const double value : values) {
    const double y = std::round(std::lerp(bar.high.y, bar.low.y, (value - low) / (high - low)) - 0.5 * layout.line);
    const Area mark{{bar.low.x - layout.line - tick, y}, {bar.low.x - layout.line, y + layout.line}};
    drawFrame(image, {mark.low, {mark.high.x - layout.line, mark.high.y}}, layout.line, ink.outline);
    fillRectangle(image, mark.low, mark.high, ink.fill);
    const std::string text = valueText(value, values.size() > 1 ? values[1] - values[0] : std::abs(value));
    const glm::dvec2 baseline(mark.low.x - 0.4 * layout.em - textWidth(text, layout.em), y + 0.5 * (layout.line + textHeight(layout.em)));
    drawText(image, baseline, text, layout.em, ink);
  }
  drawText(image, {right - textWidth(unit, layout.em), bar.low.y - 0.7 * layout.em}, unit, layout.em, ink);
}

/// `pixel` is the edge of a pixel in the world.
void drawScaleBar(Image& image, double pixel, const std::string& unit, const std::optional<Background>& behind, const Layout& layout) {
  constexpr double kMaxOfWidth = 0.25;
  const double length = roundLength(kMaxOfWidth * (layout.part.high.x - layout.part.low.x) * pixel);
  const double height = std::max(2.0, std::round(layout.em / 5.0));
  const glm::dvec2 low(layout.part.low.x + layout.gap, layout.part.high.y - layout.gap - height);
  const Area bar{low, low + glm::dvec2(length / pixel, height)};
  const Ink ink = inkOver(image, behind, {bar.low - glm::dvec2(0.0, 2.0 * layout.em), bar.high});
  drawFrame(image, bar, layout.line, ink.outline);
  fillRectangle(image, bar.low, bar.high, ink.fill);
  const std::string text = lengthText(length, unit);
  const double middle = 0.5 * (bar.low.x + bar.high.x) - 0.5 * textWidth(text, layout.em);
  drawText(image, {std::max(middle, bar.low.x), bar.low.y - 0.6 * layout.em}, text, layout.em, ink);
}

}  // namespace

std::vector<double> roundValues(double low, double high) {
  std::vector<double> values;
  constexpr std::array kDigits{1.0, 2.0, 2.5, 5.0};
  const double decade = std::floor(std::log10((high - low) / double(kMaxValues)));
  for (std::size_t i = 0; i < 3 * kDigits.size(); ++i) {
    const double step = kDigits[i % kDigits.size()] * std::pow(10.0, decade + double(i / kDigits.size()));
    const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
    if (last - first >= double(kMaxValues)) continue;
    for (double number = first; number <= last; ++number) values.push_back(number * step);
    return values;
  }
  return values;
}

double roundLength(double most) {
  const double power = std::pow(10.0, std::floor(std::log10(most) + 1e-9)), digits = most / power * (1.0 + 1e-9);
  return power * (digits >= 5.0 ? 5.0 : digits >= 2.0 ? 2.0 : 1.0);
}

std::string lengthText(double length, const std::string& unit) {
  if (unit != "mm") return fmt::format("{:.6g}{}{}", length, unit.empty() ? "" : " ", unit);
  struct Unit {
    const char* name;
    double millimetres, least;  ///< from which length on it is used
  };
  constexpr std::array kUnits{Unit{"km", 1e6, 1e6}, Unit{"m", 1e3, 1e3},         Unit{"cm", 10.0, 100.0},
                              Unit{"mm", 1.0, 1.0}, Unit{"\u00b5m", 1e-3, 1e-3}, Unit{"nm", 1e-6, 0.0}};
  const auto fits = [length](const Unit& one) { return length >= one.least * (1.0 - 1e-9); };
  const Unit& used = *std::ranges::find_if(kUnits, fits);
  return fmt::format("{:.6g} {}", length / used.millimetres, used.name);
}

bool canAnnotate(const SceneDescription& description, const Scene& scene) {
  return scene.camera.orthographic || hasColorBar(description, scene);
}

void annotate(Image& image, const SceneDescription& description, const Scene& scene) {
  if (!description.method.annotate) return;
  const std::optional<Background> behind = description.output.look().background;
  const Layout layout(description.output.crop.value_or(PixelRectangle{.corner = glm::ivec2(0), .size = image.size}));
  if (hasColorBar(description, scene))
    drawColorBar(image, scene.classification, description.method.isProjected(), valueUnit(description, *scene.volume), behind, layout);
  if (scene.camera.orthographic)
    drawScaleBar(image, scene.camera.orthographicHeight / image.size.y, scene.volume->lengthUnit, behind, layout);
}

}  // namespace freevoxels
