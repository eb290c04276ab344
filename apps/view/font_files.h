#pragma once
// The fonts of the window, which are in the program: other machines have others, or none.

#include <span>

namespace freevoxels {

/// The bytes of DejaVu Sans and DejaVu Sans Mono, TrueType files.
std::span<const unsigned char> sansFont();
std::span<const unsigned char> monospacedFontFile();

}  // namespace freevoxels
