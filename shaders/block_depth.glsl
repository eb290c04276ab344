// Optical depth from a block towards an eye or a light, from the table.
#ifndef BLOCK_DEPTH_GLSL
#define BLOCK_DEPTH_GLSL
#include "block_at.glsl"
#include "direction_lookup.glsl"
#include "major_axis.glsl"

const float kAtSource = 1e-3;  // in voxels: at a smaller distance from an eye or a light the direction is undefined

// The direction divided by its largest component, so that its length is that of one lattice layer.
vec3 acrossLayer(vec3 direction) {
  const vec3 size = abs(direction);
  return direction / max(size.x, max(size.y, size.z));
}

// The same direction in world units.
float layerLength(vec3 direction) { return length(frame.indexToWorld * direction); }

// The number of layers of voxels that a line in this direction crosses in a block.
int layersOf(Block block, vec3 direction) { return block.extent[majorAxis(direction)]; }

// `lookup` and `beyond` as TableLookup has them.
TableLookup towardsSource(vec3 direction, int lookup, uvec2 beyond) {
  const bool inFull = frame.pathLengthCorrection != 0;
  const float layer = layerLength(direction);
  return TableLookup(direction, layer, frame.indexToWorld, frame.cells, frame.code, lookup, inFull,
                 inFull ? layer : frame.voxelSize, beyond);
}

// The mean optical depth of the voxels of an occupied block. `unsaturated` is as in depthTowards.
float meanDepth(Block block, TableLookup towards, out float unsaturated) {
  const BlockLevel level = frame.levels[block.level];
  return depthTowards(towards, rankAt(level, blockAddress(level, block.cell)), unsaturated);
}

// The optical depth in front of a block. The mean depth is that of its middle layer, so the block's own
// layers in front of that are subtracted. Where the table ends, the depth is kept as it was a layer before:
// otherwise blocks deep inside an opaque medium would shine at their rims. `layerDepth` is what one layer
// counts in the depth.
float depthInFront(Block block, vec3 direction, float depth, float layerDepth) {
  return max(depth - 0.5 * float(layersOf(block, direction) - 1) * layerDepth, 0.0);
}

#endif
