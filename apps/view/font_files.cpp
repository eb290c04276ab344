#include "apps/view/font_files.h"

#include "apps/view/embedded_file.h"

FREEVOXELS_EMBED(freevoxels_sans_font, FREEVOXELS_SANS_FONT);
FREEVOXELS_EMBED(freevoxels_mono_font, FREEVOXELS_MONO_FONT);

namespace freevoxels {

std::span<const unsigned char> sansFont() {
  return {freevoxels_sans_font, freevoxels_sans_font_end};
}

std::span<const unsigned char> monospacedFontFile() {
  return {freevoxels_mono_font, freevoxels_mono_font_end};
}

}  // namespace freevoxels
