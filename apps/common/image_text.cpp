#include "apps/common/image_text.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "apps/common/glyph.h"

namespace freevoxels {

namespace {

constexpr double kCapitals = 0.729;      ///< height of the capitals of the font, in ems
constexpr double kOutline = 1.0 / 14.0;  ///< width of the outline, in ems
constexpr double kMinOutline = 0.8;      ///< the same in pixels
constexpr double kHalfPixel = 0.5;
constexpr double kDarkStrokes = 0.3;  ///< pixels by which dark strokes are wider, which look thin where light is blended

/// Blends a colour over a pixel that it covers in part. What is beyond the image is left out.
void blend(Image& image, glm::ivec2 place, glm::vec3 color, double coverage) {
  if (place.x < 0 || place.y < 0 || place.x >= image.size.x || place.y >= image.size.y || !(coverage > 0.0)) return;
  glm::vec4& pixel = image.pixels[std::size_t(place.y) * std::size_t(image.size.x) + std::size_t(place.x)];
  pixel = glm::mix(pixel, glm::vec4(color, 1.0f), float(std::min(coverage, 1.0)));
}

/// The glyphs of a text; null for characters that there are not.
std::vector<const Glyph*> glyphsOf(std::string_view text) {
  std::vector<const Glyph*> found;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const int more = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : lead >= 0xc0 ? 1 : 0;
    int code = more == 0 ? lead : lead & (0x3f >> more);
    for (int byte = 0; byte < more && ++i < text.size(); ++byte) code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3f);
    ++i;
    const auto glyph = std::ranges::lower_bound(glyphs(), code, {}, &Glyph::character);
    if (glyph != glyphs().end() && glyph->character == code) found.push_back(&*glyph);
  }
  return found;
}

/// The distance from a glyph's outline in texels, above 0 inside, at a place of its image.
double distanceAt(const Glyph& glyph, glm::dvec2 place) {
  const glm::dvec2 last(glyph.size[0] - 1, glyph.size[1] - 1);
  const glm::dvec2 inside = glm::clamp(place - kHalfPixel, glm::dvec2(0.0), last);
  const glm::ivec2 low(inside), high = glm::min(low + 1, glm::ivec2(last));
  const auto texel = [&](int x, int y) {
    return double(glyphTexels()[glyph.first + std::size_t(y) * std::size_t(glyph.size[0]) + std::size_t(x)]);
  };
  const glm::dvec2 part = inside - glm::dvec2(low);
  const double mean = std::lerp(std::lerp(texel(low.x, low.y), texel(high.x, low.y), part.x),
                                std::lerp(texel(low.x, high.y), texel(high.x, high.y), part.x), part.y);
  return (mean - Glyph::kOnOutline) / Glyph::kStepsPerTexel;
}

/// Draws a glyph that is wider than its outline by so many pixels.
void drawGlyph(Image& image, const Glyph& glyph, glm::dvec2 origin, double scale, double wider, glm::vec3 color) {
  if (glyph.size[0] == 0) return;  // a space
  const glm::dvec2 corner = origin + scale * glm::dvec2(glyph.corner[0], glyph.corner[1]);
  const glm::dvec2 end = corner + scale * glm::dvec2(glyph.size[0], glyph.size[1]);
  for (int y = int(std::floor(corner.y)); y < int(std::ceil(end.y)); ++y)
    for (int x = int(std::floor(corner.x)); x < int(std::ceil(end.x)); ++x) {
      const glm::dvec2 place = (glm::dvec2(x, y) + kHalfPixel - corner) / scale;
      blend(image, {x, y}, color, kHalfPixel + wider + scale * distanceAt(glyph, place));
    }
}

}  // namespace

void fillRectangle(Image& image, glm::dvec2 low, glm::dvec2 high, glm::vec3 color) {
  const auto covered = [](double from, double to, int pixel) { return std::min(to, pixel + 1.0) - std::max(from, double(pixel)); };
  const glm::dvec2 begin = glm::max(low, glm::dvec2(0.0)), end = glm::min(high, glm::dvec2(image.size));
  for (int y = int(std::floor(begin.y)); y < int(std::ceil(end.y)); ++y)
    for (int x = int(std::floor(begin.x)); x < int(std::ceil(end.x)); ++x)
      blend(image, {x, y}, color, covered(begin.x, end.x, x) * covered(begin.y, end.y, y));
}

double textWidth(std::string_view text, double em) {
  double width = 0.0;
  for (const Glyph* const glyph : glyphsOf(text)) width += em / Glyph::kEm * glyph->advance;
  return width;
}

double textHeight(double em) {
  return kCapitals * em;
}

void drawText(Image& image, glm::dvec2 baseline, std::string_view text, double em, const Ink& ink) {
  const double scale = em / Glyph::kEm, outline = std::max(kOutline * em, kMinOutline);
  const std::vector<const Glyph*> line = glyphsOf(text);
  const double bolder = ink.fill.g < ink.outline.g ? kDarkStrokes : 0.0;
  for (const auto& [wider, color] : {std::pair(bolder + outline, ink.outline), {bolder, ink.fill}}) {
    glm::dvec2 origin = baseline;
    for (const Glyph* const glyph : line) {
      drawGlyph(image, *glyph, origin, scale, wider, color);
      origin.x += scale * glyph->advance;
    }
  }
}

}  // namespace freevoxels
