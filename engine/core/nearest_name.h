#pragma once
// Suggestions for mistyped names.

#include <span>
#include <string>

namespace freevoxels {

/// The number of letters to insert, remove or replace that makes one name of the other (Levenshtein 1965).
std::size_t editDistance(const std::string& a, const std::string& b);

/// The edit distance from which on a name is no longer suggested.
inline constexpr std::size_t kFarName = 4;

/// The known name nearest to `name`. Empty if none is nearer than kFarName and nearer than the length of `name`.
std::string nearestName(const std::string& name, std::span<const std::string> known);

/// "; did you mean 'NAME'?" with the nearest name. Empty if there is none.
std::string suggestion(const std::string& name, std::span<const std::string> known);

}  // namespace freevoxels
