#pragma once
// Text and rectangles over images.

#include <glm/glm.hpp>
#include <string_view>

#include "engine/image/image.h"

namespace freevoxels {

/// Colours that are seen over everything: a text of one with a thin outline of the other. Linear Rec.709.
struct Ink {
  glm::vec3 fill{1.0f}, outline{0.0f};
};

/// Fills a rectangle of pixels, which may end within pixels and beyond the image, opaquely.
void fillRectangle(Image& image, glm::dvec2 low, glm::dvec2 high, glm::vec3 color);

/// The width of a text in pixels, in a font of which an em has so many. UTF-8; characters that the font has not are left out.
double textWidth(std::string_view text, double em);
/// The height of its digits and capital letters.
double textHeight(double em);
/// Draws a text from a point of its baseline to the right.
void drawText(Image& image, glm::dvec2 baseline, std::string_view text, double em, const Ink& ink);

}  // namespace freevoxels
