#include "engine/validation/report.h"

#include <algorithm>

namespace freevoxels {

bool ReportSection::passed() const {
  return std::ranges::all_of(checks, [](const Check& check) { return check.passed(); });
}

bool Report::passed() const {
  return std::ranges::all_of(sections, [](const ReportSection& section) { return section.passed(); });
}

}  // namespace freevoxels
