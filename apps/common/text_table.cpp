#include "apps/common/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace freevoxels {

std::vector<std::string> TextTable::lines() const {
  std::vector<std::size_t> widths(columns.size(), 0);
  for (const auto& row : rows)
    for (std::size_t i = 0; i < columns.size(); ++i) widths[i] = std::max(widths[i], row[i].size());

  std::vector<std::string> result;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i > 0) line += "  ";
      line += columns[i] == Align::Left ? fmt::format("{:<{}}", row[i], widths[i]) : fmt::format("{:>{}}", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    result.push_back(std::move(line));
  }
  return result;
}

std::string bytesText(std::uint64_t bytes) {
  constexpr std::array kUnits{"KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  if (bytes < 1024) return fmt::format("{} B", bytes);
  double value = double(bytes) / 1024.0;
  std::size_t unit = 0;
  for (; value >= 1024.0; value /= 1024.0) ++unit;
  return fmt::format("{:.1f} {}", value, kUnits[unit]);
}

}  // namespace freevoxels
