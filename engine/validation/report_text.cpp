#include "engine/validation/report_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace freevoxels {

namespace {

constexpr double kLargestWhole = 1e15, kSmallestPlain = 1e-3, kLargestPlain = 1e6;
constexpr int kEnoughDigits = 17;  // distinguishes any two doubles

std::string superscript(const std::string& number) {
  static const std::array<std::string, 10> kDigits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text;
  for (const char c : number) text += c == '-' ? "⁻" : kDigits[std::size_t(c - '0')];
  return text;
}

const char* signOf(double value) {
  return value < 0.0 ? "−" : "";
}

}  // namespace

std::string escapeHtml(std::string_view text) {
  std::string safe;
  for (const char c : text) switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default: {
        const auto byte = static_cast<unsigned char>(c);
        const bool control = (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f;
        safe += control ? "\uFFFD" : std::string(1, c);
      }
    }
  return safe;
}

std::string powerText(double value, int digits) {
  const std::string scientific = fmt::format("{:.{}e}", std::abs(value), digits - 1);
  const std::size_t e = scientific.find('e');
  return fmt::format("{}{}·10{}", signOf(value), scientific.substr(0, e),
                     superscript(std::to_string(std::stoi(scientific.substr(e + 1)))));
}

std::string figureText(double value, int digits) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
  const double size = std::abs(value);
  if (size < kLargestWhole && size == std::floor(size)) return fmt::format("{}{:.0f}", signOf(value), size);
  if (size < kSmallestPlain || size >= kLargestPlain) return powerText(value, digits);
  const int exponent = int(std::floor(std::log10(size)));
  return fmt::format("{}{:.{}f}", signOf(value), size, std::max(0, digits - 1 - exponent));
}

std::string figureTextBeside(double value, double other) {
  int digits = 4;
  const auto rounded = [&](double number) { return fmt::format("{:.{}e}", number, digits - 1); };
  while (value != other && digits < kEnoughDigits && rounded(value) == rounded(other)) ++digits;
  return figureText(value, digits);
}

}  // namespace freevoxels
