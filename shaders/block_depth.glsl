// Optical depth from a block towards an eye or a light, from the table.
#ifndef BLOCK_DEPTH_GLSL
#define BLOCK_DEPTH_GLSL
#include "block_at.glsl"
#include "direction_lookup.glsl"
#include "major_axis.glsl"

const float kAtSource = 1e-3;  // voxels; nearer to an eye or a light a position has no direction

// Divided by its largest component, so that its length is that of one lattice layer.
vec3 acrossLayer(vec3 direction) {
  const vec3 size = abs(direction);
  return direction / max(size.x, max(size.y, size.z));
}

// In world units.
float layerLength(vec3 direction) { return length(frame.indexToWorld * direction); }

// How many layers of voxels a line in this direction crosses in a block.
int layersOf(Block block, vec3 direction) { return block.extent[majorAxis(direction)]; }

// `lookup` and `beyond` as TableLookup has them.
TableLookup towardsSource(vec3 direction, int lookup, uvec2 beyond) {
  const bool inFull = frame.pathLengthCorrection != 0;
  const float layer = layerLength(direction);
  return TableLookup(direction, layer, frame.indexToWorld, frame.cells, frame.code, lookup, inFull,
                 inFull ? layer : frame.voxelSize, beyond);
}

// The mean over the voxels of a block that holds anything; `unsaturated` as depthTowards has it.
float meanDepth(Block block, TableLookup towards, out float unsaturated) {
  const BlockLevel level = frame.levels[block.level];
  return depthTowards(towards, rankAt(level, blockAddress(level, block.cell)), unsaturated);
}

// A block's mean depth is that of its middle layer: what lies in front of it is less by its own layers before. Where the
// table ends, a depth is the same a layer before: what is deep in an opaque medium would shine at its rim if the layers
// were taken off. `layerDepth` is what the depth counts of one.
float depthInFront(Block block, vec3 direction, float depth, float layerDepth) {
  return max(depth - 0.5 * float(layersOf(block, direction) - 1) * layerDepth, 0.0);
}

#endif
