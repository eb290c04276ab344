#pragma once
// Text tables for terminals.

#include <cstdint>
#include <string>
#include <vector>

namespace freevoxels {

struct TextTable {
  enum class Align { Left, Right };

  std::vector<Align> columns;
  std::vector<std::vector<std::string>> rows;  ///< the first row is the heading

  /// One string for each row, with two spaces between columns.
  std::vector<std::string> lines() const;
};

/// "1.5 MiB"
std::string bytesText(std::uint64_t bytes);

}  // namespace freevoxels
