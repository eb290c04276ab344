// Writes the glyphs of a font as a source file, at build time:
//   make_glyphs FONT.ttf GLYPHS.cpp
// A glyph is an image of distances to its outline, which can be drawn in any size (image_text.h).

#define STB_TRUETYPE_IMPLEMENTATION
#include <stb_truetype.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "apps/common/glyph.h"

namespace {

using freevoxels::Glyph;

/// ASCII, the micro sign and the minus sign.
std::vector<int> characters() {
  std::vector<int> all;
  for (int code = 0x20; code <= 0x7e; ++code) all.push_back(code);
  all.insert(all.end(), {0xb5, 0x2212});
  return all;
}

void writeGlyph(std::ostream& table, std::ostream& texels, const stbtt_fontinfo& font, int code, std::size_t& first) {
  const float scale = stbtt_ScaleForMappingEmToPixels(&font, float(Glyph::kEm));
  int width = 0, height = 0, left = 0, top = 0, advance = 0, bearing = 0;
  stbtt_GetCodepointHMetrics(&font, code, &advance, &bearing);
  unsigned char* const distances = stbtt_GetCodepointSDF(&font, scale, code, Glyph::kMargin, Glyph::kOnOutline,
                                                         float(Glyph::kStepsPerTexel), &width, &height, &left, &top);
  table << "    {" << code << ", " << double(advance) * double(scale) << ", {" << left << ", " << top << "}, {" << width << ", " << height
        << "}, " << first << "},\n";
  const std::size_t count = distances != nullptr ? std::size_t(width) * std::size_t(height) : 0;
  for (std::size_t i = 0; i < count; ++i) texels << int(distances[i]) << (i + 1 == count ? ",\n" : ",");
  first += count;
  stbtt_FreeSDF(distances, nullptr);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  std::ifstream file(arguments[1], std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  stbtt_fontinfo font;
  if (bytes.empty() || stbtt_InitFont(&font, reinterpret_cast<const unsigned char*>(bytes.data()), 0) == 0) {
    std::fprintf(stderr, "make_glyphs: '%s' is no font\n", arguments[1]);
    return 1;
  }
  std::ostringstream table, texels;
  std::size_t first = 0;
  for (const int code : characters()) writeGlyph(table, texels, font, code, first);
  std::ofstream source(arguments[2]);
  source << "#include \"apps/common/glyph.h\"\n\nnamespace freevoxels {\n\nnamespace {\n\nconstexpr std::uint8_t kTexels[] = {\n"
         << texels.str() << "};\nconstexpr Glyph kGlyphs[] = {\n"
         << table.str() << "};\n\n}  // namespace\n\n"
         << "std::span<const Glyph> glyphs() { return kGlyphs; }\nstd::span<const std::uint8_t> glyphTexels() { return kTexels; }\n\n"
         << "}  // namespace freevoxels\n";
  return source.flush() ? 0 : 1;
}
