#pragma once
// Files that are put into the program.

/// `name` and `name`_end are the addresses of the first byte of the file and of the one behind the last. The assembler reads it, as a
/// compiler that reads its bytes as numbers takes seconds.
#define FREEVOXELS_EMBED(name, path)          \
  __asm__(                                    \
      ".section .rodata\n"                    \
      ".global " #name "\n.balign 16\n" #name \
      ":\n"                                   \
      ".incbin \"" path                       \
      "\"\n"                                  \
      ".global " #name "_end\n" #name         \
      "_end:\n"                               \
      ".previous\n");                         \
  extern "C" const unsigned char name[], name##_end[]
