// Of a word of occupancy, its mask and the count before: how many blocks of the level that hold anything come before the
// one of this bit.
uint rankIn(uvec2 word, int bit) { return word.y + bitCount(bitfieldExtract(word.x, 0, bit)); }
