#include "apps/view/font_files.h"

// The assembler puts the files into the program, for which a compiler that reads them as numbers takes seconds.
#define FREEVOXELS_FILE(name, path)         \
  __asm__(                                  \
      ".section .rodata\n"                  \
      ".global " name "\n.balign 16\n" name \
      ":\n"                                 \
      ".incbin \"" path                     \
      "\"\n"                                \
      ".global " name "_end\n" name         \
      "_end:\n"                             \
      ".previous\n")

FREEVOXELS_FILE("freevoxels_sans_font", FREEVOXELS_SANS_FONT);
FREEVOXELS_FILE("freevoxels_mono_font", FREEVOXELS_MONO_FONT);

extern "C" {
extern const unsigned char freevoxels_sans_font[], freevoxels_sans_font_end[];
extern const unsigned char freevoxels_mono_font[], freevoxels_mono_font_end[];
}

namespace freevoxels {

std::span<const unsigned char> sansFont() {
  return {freevoxels_sans_font, freevoxels_sans_font_end};
}

std::span<const unsigned char> monospacedFontFile() {
  return {freevoxels_mono_font, freevoxels_mono_font_end};
}

}  // namespace freevoxels
