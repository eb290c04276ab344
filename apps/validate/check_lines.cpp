#include "apps/validate/check_lines.h"

#include <fmt/format.h>

#include "apps/common/text_table.h"

namespace freevoxels::validate {

std::vector<std::string> checkLines(const ReportSection& section) {
  using enum TextTable::Align;
  TextTable table{.columns = {Left, Left, Right, Left, Left}, .rows = {}};
  for (const Check& check : section.checks)
    table.rows.push_back(
        {check.passed() ? "  passed" : "  FAILED", check.name, fmt::format("{:.3g}", check.figure),
         fmt::format("{} {:g} {}", check.bound == Check::Bound::AtMost ? "<=" : ">=", check.tolerance,
                     check.unit),
         check.where});
  std::vector<std::string> lines = table.lines();
  lines.insert(lines.begin(), section.title);
  return lines;
}

std::string figureAgainstBound(const Check& check) {
  return fmt::format("{:.4g} where {} {:g} {}is allowed{}", check.figure,
                     check.bound == Check::Bound::AtMost ? "at most" : "at least", check.tolerance,
                     check.unit.empty() ? "" : check.unit + " ",
                     check.where.empty() ? "" : ", worst at " + check.where);
}

}  // namespace freevoxels::validate
