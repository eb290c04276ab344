// The rank of an occupied block within its level, from a word of the occupancy: its mask and the count of occupied blocks before it.
#ifndef RANK_GLSL
#define RANK_GLSL

uint rankIn(uvec2 word, int bit) { return word.y + bitCount(bitfieldExtract(word.x, 0, bit)); }

#endif
