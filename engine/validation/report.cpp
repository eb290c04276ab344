#include "engine/validation/report.h"

#include <algorithm>

namespace freevoxels {

std::size_t ReportSection::failures() const {
  return std::size_t(std::ranges::count_if(checks, [](const Check& check) { return !check.passed(); }));
}

std::size_t Report::checkCount() const {
  std::size_t count = 0;
  for (const ReportSection& section : sections) count += section.checks.size();
  return count;
}

std::size_t Report::failures() const {
  std::size_t count = 0;
  for (const ReportSection& section : sections) count += section.failures();
  return count;
}

}  // namespace freevoxels
