// Optical depth between a block and the eye, exclusive of the block, and its gradient across the lines of
// sight. Include after block_depth.glsl and ray_lookup.glsl.

vec3 directionToEye(vec3 position) {
  vec3 toEye = -(position - frame.middle + frame.eyeToMiddle);
  if (frame.orthographic != 0 || dot(toEye, toEye) < kAtSource * kAtSource) toEye = -frame.ray;
  return acrossLayer(toEye);
}

float tableDepth(Block block, out float falling) {
  return meanDepth(block, towardsSource(directionToEye(block.center), frame.lookup, frame.beyondEye), falling);
}

// Of the block, or of itself where that holds nothing: the table does not know it.
Block neighbour(Block block, int axis, int steps) {
  ivec3 cell = block.cell;
  cell[axis] += steps;
  const BlockLevel level = frame.levels[block.level];
  return isInside(level, cell) && holdsAnything(blockAddress(level, cell)) ? blockOf(block.level, cell) : block;
}

// Between the neighbours, each with its own line of sight; one-sided where one of them holds nothing.
float tableSlope(Block block, int axis) {
  const Block before = neighbour(block, axis, -1), after = neighbour(block, axis, 1);
  float unused;
  return (tableDepth(after, unused) - tableDepth(before, unused)) / max(after.center[axis] - before.center[axis], 1.0);
}

// At the block's centre, which may lie between two planes: then the mean of what the line of sight has there.
vec3 rayDepthOf(RayFan fan, Block block, vec3 direction) {
  if (block.extent[fan.axis] % 2 == 1) return rayDepth(fan, block.center);
  return 0.5 * (rayDepth(fan, block.center + 0.5 * direction) + rayDepth(fan, block.center - 0.5 * direction));
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
  float falling = 1.0;
  const int fan = fanIndex(-direction);
  const int axis = frame.lookup == kLookupExact ? frame.fans[fan].axis : fan / 2;
  const int sideA = (axis + 1) % 3, sideB = (axis + 2) % 3;
  vec2 slope = vec2(0.0);
  if (frame.lookup == kLookupExact) {
    const vec3 ray = rayDepthOf(frame.fans[fan], block, direction);
    result.depth = ray.x;
    slope = ray.yz;
  } else {
    result.depth = tableDepth(block, falling);
    if (frame.gradient != 0) slope = vec2(tableSlope(block, sideA), tableSlope(block, sideB));
  }
  const float fallingSigma = falling * sigma, layerDepth = fallingSigma * layerLength(direction);
  const bool inFull = frame.lookup == kLookupExact || frame.pathLengthCorrection != 0;
  result.depth = depthInFront(block, direction, result.depth, inFull ? layerDepth : fallingSigma * frame.voxelSize);
  if (frame.gradient == 0) return result;
  result.gradient[sideA] = slope.x;
  result.gradient[sideB] = slope.y;
  // Along the line of sight the depth falls by that of a layer.
  result.gradient[axis] = -(layerDepth + dot(result.gradient, direction)) / direction[axis];
  return result;
}
