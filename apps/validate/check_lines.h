#pragma once
// The checks of a section as text for a terminal.

#include <string>
#include <vector>

#include "engine/validation/report.h"

namespace freevoxels::validate {

/// The section's title, then a line for each check: verdict, name, figure, bound, unit, and the place of the
/// worst figure.
std::vector<std::string> checkLines(const ReportSection& section);

/// "1.2e-05 > 1e-05 relative, pixel (1, 2)"
std::string figureAgainstBound(const Check& check);

}  // namespace freevoxels::validate
