#pragma once
// Units of lengths as files of microscopes name them.

#include <optional>
#include <string>

namespace freevoxels {

/// Millimetres of a unit: "micrometer", "µm", "nm". Nothing for other words, such as "pixel".
std::optional<double> millimetresOf(const std::string& unit);

}  // namespace freevoxels
