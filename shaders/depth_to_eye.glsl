// Optical depth between a block and the eye, without the block itself, and its gradient across the lines of
// sight.
#ifndef DEPTH_TO_EYE_GLSL
#define DEPTH_TO_EYE_GLSL
#include "block_depth.glsl"

vec3 directionToEye(vec3 position) {
  vec3 toEye = -(position - frame.middle + frame.eyeToMiddle);
  if (frame.orthographic != 0 || dot(toEye, toEye) < kAtSource * kAtSource) toEye = -frame.ray;
  return acrossLayer(toEye);
}

float tableDepth(Block block, out float unsaturated) {
  return meanDepth(block, towardsSource(directionToEye(block.center), frame.lookup, frame.sourceDepth), unsaturated);
}

// The depth of a neighbour, or of the block itself if the neighbour is not occupied: the table does not have
// it.
Block neighbour(Block block, int axis, int steps) {
  ivec3 cell = block.cell;
  cell[axis] += steps;
  const BlockLevel level = frame.levels[block.level];
  return isInside(level, cell) && isOccupied(blockAddress(level, cell)) ? blockOf(block.level, cell) : block;
}

// The difference between both neighbours, each with its own line of sight; one-sided if one of them is not
// occupied.
float tableSlope(Block block, int axis) {
  const Block before = neighbour(block, axis, -1), after = neighbour(block, axis, 1);
  float unused;
  return (tableDepth(after, unused) - tableDepth(before, unused)) / max(after.center[axis] - before.center[axis], 1.0);
}

struct DepthToEye {
  float depth;
  vec3 gradient;  // per voxel, index space
};

// `sigma` is the block's extinction.
DepthToEye depthToEye(Block block, float sigma) {
  DepthToEye result = DepthToEye(0.0, vec3(0.0));
  if (frame.lookup == kLookupNone) return result;
  const vec3 direction = directionToEye(block.center);
  const int axis = majorAxis(direction);
  float unsaturated;
  const float middle = tableDepth(block, unsaturated);
  // A layer dims the light by `layerDepth`, and counts `countedDepth` in the stored depths.
  const float unsaturatedSigma = unsaturated * sigma, layerDepth = unsaturatedSigma * layerLength(direction);
  const float countedDepth = frame.pathLengthCorrection != 0 ? layerDepth : unsaturatedSigma * frame.voxelSize;
  result.depth = depthInFront(block, direction, middle, countedDepth);
  if (frame.gradient == 0) return result;
  result.gradient[(axis + 1) % 3] = tableSlope(block, (axis + 1) % 3);
  result.gradient[(axis + 2) % 3] = tableSlope(block, (axis + 2) % 3);
  // Along the line of sight, the depth falls by that of one layer.
  result.gradient[axis] = -(layerDepth + dot(result.gradient, direction)) / direction[axis];
  return result;
}

#endif
