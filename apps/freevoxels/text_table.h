#pragma once
// Columns of text for people.

#include <cstdint>
#include <string>
#include <vector>

namespace freevoxels {

struct TextTable {
  enum class Align { Left, Right };

  std::vector<Align> columns;
  std::vector<std::vector<std::string>> rows;  ///< the first is the heading

  /// One string a row, columns two spaces apart.
  std::vector<std::string> lines() const;
};

/// "1.5 MiB"
std::string bytesText(std::uint64_t bytes);

}  // namespace freevoxels
