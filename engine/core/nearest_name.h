#pragma once
// Which name somebody may have meant who typed an unknown one.

#include <span>
#include <string>

namespace freevoxels {

/// The number of letters to insert, remove or replace that makes one name of the other (Levenshtein 1965).
std::size_t editDistance(const std::string& a, const std::string& b);

/// Names that differ by as many letters are different names.
inline constexpr std::size_t kFarName = 4;

/// "; did you mean 'NAME'?" of the known name nearest to `name`, or nothing where each is as far as kFarName or as `name` is long.
std::string suggestion(const std::string& name, std::span<const std::string> known);

}  // namespace freevoxels
