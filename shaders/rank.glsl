// The rank within its level of the block at a bit of an occupancy word (mask, number of occupied blocks
// before the word).
uint rankIn(uvec2 word, int bit) { return word.y + bitCount(bitfieldExtract(word.x, 0, bit)); }
