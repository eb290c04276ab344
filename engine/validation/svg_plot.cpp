#include "engine/validation/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "engine/validation/report_text.h"

namespace freevoxels {

namespace {

// In units of the SVG's view box, which are about a pixel.
constexpr double kWidth = 720.0, kPlotTop = 14.0, kPlotHeight = 300.0, kPlotLeft = 84.0, kPlotRight = 704.0;
constexpr double kPlotBottom = kPlotTop + kPlotHeight;
constexpr double kLegendTop = kPlotBottom + 56.0, kLegendRow = 22.0, kLegendSample = 34.0;
constexpr double kLetter = 7.2;               // average width of a letter
constexpr std::size_t kPointsWithMarks = 64;  // more marks would hide the line
constexpr double kLargestCoordinate = 1e300;  // so that differences stay finite

constexpr double kSmallestRange = 1e-300;                     // so that steps are not 0
constexpr double kSmallestPlain = 1e-3, kLargestPlain = 1e6;  // axes beyond them count in powers of ten
constexpr double kSlack = 1e-9;  // in steps: rounding must not add a step where an end lies on a tick

constexpr std::array<const char*, 7> kColors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                "#E69F00", "#56B4E9", "#000000"};
constexpr std::array<const char*, 4> kMarks = {"M-3.5,0a3.5,3.5 0 1,0 7,0a3.5,3.5 0 1,0 -7,0z",
                                               "M-3.2,-3.2h6.4v6.4h-6.4z", "M0,-4.4L4.2,3.2H-4.2z",
                                               "M0,-4.6L4.2,0L0,4.6L-4.2,0z"};
/// In the element itself, so that it looks the same as a file of its own.
constexpr const char* kStyle =
    R"css(.plot text { fill: #1c2126; font: 12px "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif; }
.plot .label { font-size: 13px; }
.plot .grid { fill: none; stroke: #e6eaed; stroke-width: 1; }
.plot .axis { fill: none; stroke: #1c2126; stroke-width: 1; }
.plot .line { fill: none; stroke-width: 1.8; stroke-linejoin: round; })css";
/// Marks change with every seven series, when the colours repeat.
constexpr std::array<const char*, 3> kDashes = {"", "7 4", "2 3"};

bool canShow(glm::dvec2 point) {
  return std::abs(point.x) <= kLargestCoordinate && std::abs(point.y) <= kLargestCoordinate;
}

/// The range of the finite values, slightly wider for a single value.
Ticks ticksOf(const ReportPlot& plot, int axis, int count) {
  double minimum = std::numeric_limits<double>::infinity(), maximum = -minimum;
  for (const ReportPlot::Series& series : plot.series)
    for (const glm::dvec2& point : series.points)
      if (canShow(point)) {
        minimum = std::min(minimum, point[axis]);
        maximum = std::max(maximum, point[axis]);
      }
  if (minimum > maximum) return {};
  const double size = std::max(std::abs(minimum), std::abs(maximum));
  if (maximum - minimum <= std::max(kSmallestRange, 1e-9 * size)) {
    const double room = size > kSmallestRange ? 0.1 * size : 1.0;
    minimum -= room;
    maximum += room;
  }
  return ticksBetween(minimum, maximum, count);
}

/// The number of digits that distinguishes neighbouring ticks of an axis.
std::string tickText(const Ticks& ticks, long long multiple) {
  const double size = std::max(std::abs(ticks.value(ticks.first)), std::abs(ticks.value(ticks.last)));
  const double value = ticks.value(multiple);
  if (multiple == 0) return "0";
  if (size < kSmallestPlain || size >= kLargestPlain)
    return powerText(value, 1 + int(std::ceil(std::log10(size / ticks.step))));
  const int decimals = std::max(0, -int(std::floor(std::log10(ticks.step) + kSlack)));
  return fmt::format("{}{:.{}f}", multiple < 0 ? "−" : "", std::abs(value), decimals);
}

class PlotWriter {
 public:
  explicit PlotWriter(const ReportPlot& plot)
      : plot_(plot), x_(ticksOf(plot, 0, 8)), y_(ticksOf(plot, 1, 6)) {}

  std::string write() {
    layLegend();
    add(R"(<svg class="plot" viewBox="0 0 {0} {1:.0f}" role="img" aria-label="{2}"><style>{3}</style>)"
        R"(<rect width="{0}" height="{1:.0f}" fill="#fff"/>)",
        kWidth, height_, escapeHtml(plot_.caption), kStyle);
    axes();
    for (std::size_t i = 0; i < plot_.series.size(); ++i) line(i);
    legend();
    return svg_ + "</svg>\n";
  }

 private:
  struct LegendEntry {
    double x, y;
  };

  template <typename... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(svg_), format, std::forward<Args>(args)...);
  }

  double left(double x) const { return kPlotLeft + (kPlotRight - kPlotLeft) * fraction(x_, x); }
  double top(double y) const { return kPlotBottom - kPlotHeight * fraction(y_, y); }
  static double fraction(const Ticks& ticks, double value) {
    return (value / ticks.step - double(ticks.first)) / double(ticks.last - ticks.first);
  }

  void axes() {
    for (long long i = x_.first; i <= x_.last; ++i) {
      const double x = left(x_.value(i));
      add(R"(<path class="grid" d="M{0:.2f},{1}V{2}"/><text class="tick" x="{0:.2f}" y="{3}" )"
          R"(text-anchor="middle">{4}</text>)",
          x, kPlotTop, kPlotBottom, kPlotBottom + 18.0, tickText(x_, i));
    }
    for (long long i = y_.first; i <= y_.last; ++i) {
      const double y = top(y_.value(i));
      add(R"(<path class="grid" d="M{0},{1:.2f}H{2}"/><text class="tick" x="{3}" y="{4:.2f}" )"
          R"(text-anchor="end">{5}</text>)",
          kPlotLeft, y, kPlotRight, kPlotLeft - 8.0, y + 4.0, tickText(y_, i));
    }
    add(R"(<path class="axis" d="M{},{}V{}H{}"/>)", kPlotLeft, kPlotTop, kPlotBottom, kPlotRight);
    add(R"(<text class="label" x="{}" y="{}" text-anchor="middle">{}</text>)", (kPlotLeft + kPlotRight) / 2.0,
        kPlotBottom + 40.0, escapeHtml(plot_.xLabel));
    add(R"svg(<text class="label" transform="translate(18,{}) rotate(-90)" text-anchor="middle">{}</text>)svg",
        (kPlotTop + kPlotBottom) / 2.0, escapeHtml(plot_.yLabel));
  }

  static const char* color(std::size_t series) { return kColors[series % kColors.size()]; }

  void path(std::size_t series, const std::string& d) {
    const char* const dash = kDashes[series / kColors.size() % kDashes.size()];
    add(R"(<path class="line" stroke="{}")", color(series));
    if (*dash) add(R"( stroke-dasharray="{}")", dash);
    add(R"( d="{}"/>)", d);
  }

  void mark(std::size_t series, double x, double y) {
    add(R"svg(<path fill="{}" transform="translate({:.2f},{:.2f})" d="{}"/>)svg", color(series), x, y,
        kMarks[series % kMarks.size()]);
  }

  void line(std::size_t index) {
    const std::vector<glm::dvec2>& points = plot_.series[index].points;
    std::string d;
    bool connected = false;
    for (const glm::dvec2& point : points) {
      if (canShow(point))
        d += fmt::format("{}{:.2f},{:.2f}", connected ? 'L' : 'M', left(point.x), top(point.y));
      connected = canShow(point);
    }
    if (!d.empty()) path(index, d);
    if (points.size() > kPointsWithMarks) return;
    for (const glm::dvec2& point : points)
      if (canShow(point)) mark(index, left(point.x), top(point.y));
  }

  /// Entries are placed in rows, as many in each as fit.
  void layLegend() {
    height_ = kLegendTop;
    if (plot_.series.size() < 2) return;
    double x = kPlotLeft, y = kLegendTop + 8.0;
    for (const ReportPlot::Series& series : plot_.series) {
      const double width = kLegendSample + kLetter * double(series.name.size()) + 20.0;
      if (x > kPlotLeft && x + width > kPlotRight) {
        x = kPlotLeft;
        y += kLegendRow;
      }
      entries_.push_back({x, y});
      x += width;
    }
    height_ = y + kLegendRow;
  }

  void legend() {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const auto [x, y] = entries_[i];
      path(i, fmt::format("M{:.2f},{:.2f}h{}", x, y, kLegendSample - 6.0));
      mark(i, x + (kLegendSample - 6.0) / 2.0, y);
      add(R"(<text class="legend" x="{:.2f}" y="{:.2f}">{}</text>)", x + kLegendSample, y + 4.5,
          escapeHtml(plot_.series[i].name));
    }
  }

  const ReportPlot& plot_;
  Ticks x_, y_;
  double height_ = 0.0;
  std::vector<LegendEntry> entries_;
  std::string svg_;
};

}  // namespace

Ticks ticksBetween(double minimum, double maximum, int count) {
  const double wanted = (maximum - minimum) / count;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= wanted) {
      step = factor * power;
      break;
    }
  return {.step = step,
          .first = static_cast<long long>(std::floor(minimum / step + kSlack)),
          .last = static_cast<long long>(std::ceil(maximum / step - kSlack))};
}

std::string svgPlot(const ReportPlot& plot) {
  return PlotWriter(plot).write();
}

}  // namespace freevoxels
