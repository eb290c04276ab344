#pragma once
// Figures and words as a report shows them.

#include <string>
#include <string_view>

namespace freevoxels {

/// Safe between tags and in a quoted attribute; control characters, which no document may hold, become
/// U+FFFD.
std::string escapeHtml(std::string_view text);

/// "1.235·10⁻⁵", "0.1235", "131072", "NaN", "∞": whole numbers below 10^15 in full, others rounded to
/// `digits` significant ones.
std::string figureText(double value, int digits = 4);

/// "1.235·10⁻⁵" of a finite value, rounded to `digits` significant digits.
std::string powerText(double value, int digits);

/// `value` with as many digits, 4 or more, as tell it from `other` where they are not equal: a figure that
/// misses its bound by little must not look as if it met it.
std::string figureTextBeside(double value, double other);

}  // namespace freevoxels
