// A block's colour. Include after block_at.glsl, transfer_function.glsl and packed_light.glsl; `frame` is the SetupFrame,
// `scalars` and `albedos` those of voxels by rank, kAlbedos says which of the two there is, `blockColors` the colours of
// the blocks above the voxels.

vec3 colorOf(Block block, uint rank) {
  if (frame.opacityPoints == 0 && !kAlbedos) return frame.albedo;
  if (block.level > 0) return unpackColor(blockColors[rank - frame.levels[1].firstRank]);
  if (kAlbedos) return unpackLight(albedos[rank]);
  return evaluatePoints(frame.opacityPoints, frame.colorPoints, scalars[rank]);
}
