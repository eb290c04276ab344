#pragma once
// A line plot as an SVG element to put into an HTML page.

#include <string>

#include "engine/validation/report.h"

namespace freevoxels {

/// Numbers at equal, round distances that span `minimum` to `maximum`, both finite, in about `count` steps.
struct Ticks {
  double step = 1.0;
  long long first = 0, last = 1;  ///< of the multiples of `step`

  double value(long long multiple) const { return step * double(multiple); }
};
Ticks ticksBetween(double minimum, double maximum, int count);

/// Axes with ticks and labels, the series in colours that colour-blind readers can tell apart (Okabe and Ito
/// 2008) and with marks of different shapes, and a legend where there is more than one.
std::string svgPlot(const ReportPlot& plot);

}  // namespace freevoxels
