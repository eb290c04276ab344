// A block's colour. Include after block_at.glsl and packed_light.glsl. `frame` is the SetupFrame; kColors
// says whether voxels have their own colours.

vec3 colorOf(Block block, uint rank) {
  if (!kColors) return frame.albedo;
  if (block.level > 0) return unpackColor(storedBlockColor(rank - frame.levels[1].firstRank));
  return unpackLight(storedColor(rank));
}
