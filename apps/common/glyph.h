#pragma once
// The glyphs of the font of annotations, as make_glyphs.cpp writes them at build time: images of distances to their outlines.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace freevoxels {

/// Lengths are in texels, of which an em has kEm; x goes to the right and y down.
struct Glyph {
  static constexpr int kEm = 32;
  static constexpr int kMargin = 5;          ///< around the outline, as far as distances are known
  static constexpr int kOnOutline = 128;     ///< the texel at distance 0; it is more inside
  static constexpr int kStepsPerTexel = 25;  ///< by which texels differ at distances that differ by 1

  int character = 0;            ///< Unicode
  double advance = 0.0;         ///< to the origin of the next glyph
  std::array<int, 2> corner{};  ///< of the image, top left, relative to the origin on the baseline
  std::array<int, 2> size{};    ///< of the image
  std::size_t first = 0;        ///< its first texel, in glyphTexels()
};

/// In the order of their characters.
std::span<const Glyph> glyphs();
std::span<const std::uint8_t> glyphTexels();

}  // namespace freevoxels
