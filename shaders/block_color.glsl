// A block's colour. Include after block_at.glsl and packed_light.glsl; `frame` is the SetupFrame, kColors says whether
// voxels have colours of their own, `colors` are those by rank, `blockColors` those of the blocks above the voxels.

vec3 colorOf(Block block, uint rank) {
  if (!kColors) return frame.albedo;
  if (block.level > 0) return unpackColor(blockColors[rank - frame.levels[1].firstRank]);
  return unpackLight(colors[rank]);
}
