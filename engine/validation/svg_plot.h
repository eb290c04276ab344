#pragma once
// A line plot as an SVG element, to put into an HTML page or, with the attribute xmlns, to write as a file of its own.

#include <string>

#include "engine/validation/report.h"

namespace freevoxels {

/// Ticks at equal, round distances that span `minimum` to `maximum`, both finite, in about `count` steps.
struct Ticks {
  double step = 1.0;
  long long first = 0, last = 1;  ///< first and last multiple of `step`

  double value(long long multiple) const { return step * double(multiple); }
};
Ticks ticksBetween(double minimum, double maximum, int count);

/// A plot with axes, ticks and labels. Series have colours that colour-blind readers can distinguish (Okabe
/// and Ito 2008) and marks of different shapes; there is a legend if there is more than one.
std::string svgPlot(const ReportPlot& plot);

}  // namespace freevoxels
