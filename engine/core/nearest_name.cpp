#include "engine/core/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace freevoxels {

std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string nearestName(const std::string& name, std::span<const std::string> known) {
  std::size_t least = std::min(kFarName, name.size());
  const std::string* nearest = nullptr;
  for (const std::string& other : known)
    if (const std::size_t distance = editDistance(name, other); distance < least) least = distance, nearest = &other;
  return nearest == nullptr ? "" : *nearest;
}

std::string suggestion(const std::string& name, std::span<const std::string> known) {
  const std::string nearest = nearestName(name, known);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

}  // namespace freevoxels
