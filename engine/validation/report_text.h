#pragma once
// The text form of figures and words in a report.

#include <string>
#include <string_view>

namespace freevoxels {

/// Escapes text for use between tags and in quoted attributes. Control characters, which no document may
/// contain, become U+FFFD.
std::string escapeHtml(std::string_view text);

/// "1.235·10⁻⁵", "0.1235", "131072", "NaN", "∞": whole numbers below 10^15 in full, others rounded to
/// `digits` significant ones.
std::string figureText(double value, int digits = 4);

/// "1.235·10⁻⁵" of a finite value, rounded to `digits` significant digits.
std::string powerText(double value, int digits);

/// `value` with at least 4 digits, and as many as distinguish it from `other` if they are not equal: a figure
/// that just misses its bound must not look as if it met it.
std::string figureTextBeside(double value, double other);

}  // namespace freevoxels
