// Optical depth between a voxel and the eye, exclusive of the voxel, and its gradient across the lines of
// sight. Include after direction_lookup.glsl and ray_lookup.glsl; `frame` is the SetupFrame.

const float kAtEye = 1e-3;  // voxels; nearer to the eye a position has no direction

// Divided by its largest component, so that its length is that of one lattice layer.
vec3 directionToEye(vec3 position) {
  vec3 toEye = -(position - frame.middle + frame.eyeToMiddle);
  if (frame.orthographic != 0 || dot(toEye, toEye) < kAtEye * kAtEye) toEye = -frame.ray;
  const vec3 size = abs(toEye);
  return toEye / max(size.x, max(size.y, size.z));
}

// In world units.
float layerLength(vec3 direction) { return length(frame.indexToWorld * direction); }

// Of an eye inside the volume: A_B / A_V of Subr et al. 2007, Section 3.3. Between the voxels around the eye, half
// of each included.
float depthBeyond(Towards towards, ivec3 cell) {
  if (frame.eyeInside == 0) return 0.0;
  const vec3 place = clamp(frame.middle - frame.eyeToMiddle, vec3(0.0), vec3(frame.dimensions - 1));
  const ivec3 low = ivec3(place);
  const vec3 w = place - vec3(low);
  float sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 side = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const vec3 share = mix(1.0 - w, w, vec3(side));
    const ivec3 v = min(low + side, frame.dimensions - 1);
    const uint index = uint(v.x + frame.rowPitch * (v.y + frame.dimensions.y * v.z));
    sum += share.x * share.y * share.z * (storedDepth(towards, cell, index) + 0.5 * towards.layer * extinction[index]);
  }
  return sum;
}

float tableDepth(vec3 position) {
  const vec3 direction = directionToEye(position);
  const Towards towards = Towards(direction, layerLength(direction), frame.indexToWorld, frame.cells, frame.code, frame.lookup,
                                  frame.pathLengthCorrection != 0);
  const ivec3 voxel = ivec3(position);
  return depthTowards(towards, uint(voxel.x + frame.rowPitch * (voxel.y + frame.dimensions.y * voxel.z)));
}

// Between the neighbours, each with its own line of sight; one-sided at the volume's faces.
float tableSlope(vec3 position, int axis) {
  vec3 before = position, after = position;
  before[axis] = max(position[axis] - 1.0, 0.0);
  after[axis] = min(position[axis] + 1.0, float(frame.dimensions[axis] - 1));
  return (tableDepth(after) - tableDepth(before)) / max(after[axis] - before[axis], 1.0);
}

struct DepthToEye {
  float depth;
  vec3 gradient;  // per voxel, index space
};

// `layerDepth` is the voxel's own, of one lattice layer.
DepthToEye depthToEye(vec3 position, float layerDepth) {
  DepthToEye result = DepthToEye(0.0, vec3(0.0));
  if (frame.lookup == kLookupNone) return result;
  const vec3 direction = directionToEye(position);
  const int fan = fanIndex(-direction);
  const int axis = frame.lookup == kLookupExact ? frame.fans[fan].axis : fan / 2;
  const int sideA = (axis + 1) % 3, sideB = (axis + 2) % 3;
  vec2 slope = vec2(0.0);
  if (frame.lookup == kLookupExact) {
    const vec3 ray = rayDepth(frame.fans[fan], position);
    result.depth = ray.x;
    slope = ray.yz;
  } else {
    result.depth = tableDepth(position);
    if (frame.gradient != 0) slope = vec2(tableSlope(position, sideA), tableSlope(position, sideB));
  }
  if (frame.gradient == 0) return result;
  result.gradient[sideA] = slope.x;
  result.gradient[sideB] = slope.y;
  // Along the line of sight the depth falls by that of a layer.
  result.gradient[axis] = -(layerDepth + dot(result.gradient, direction)) / direction[axis];
  return result;
}
