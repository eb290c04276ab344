// Optical depth between a voxel and the eye, exclusive of the voxel, and its gradient across the lines of
// sight. Include after direction_lookup.glsl; `frame` is the SetupFrame.

// Divided by its largest component, so that its length is that of one lattice layer.
vec3 directionToEye(vec3 position) {
  const vec3 toEye = frame.orthographic != 0 ? -frame.ray : -(position - frame.middle + frame.eyeToMiddle);
  const vec3 size = abs(toEye);
  return toEye / max(size.x, max(size.y, size.z));
}

// In world units.
float layerLength(vec3 direction) { return length(frame.indexToWorld * direction); }

float depthToEye(vec3 position) {
  if (frame.lookup == kLookupNone) return 0.0;
  const vec3 direction = directionToEye(position);
  const Towards towards = Towards(direction, layerLength(direction), frame.indexToWorld, frame.code, frame.lookup,
                                  frame.pathLengthCorrection != 0);
  const ivec3 voxel = ivec3(position);
  return depthTowards(towards, uint(voxel.x + frame.rowPitch * (voxel.y + frame.dimensions.y * voxel.z)));
}

// Per voxel, index space. Differences between the neighbours in the lattice layer; along the line of sight
// the depth falls by that of a layer.
vec3 depthGradient(vec3 position, float layerDepth) {
  const vec3 direction = directionToEye(position);
  const vec3 size = abs(direction);
  const int major = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  vec3 gradient = vec3(0.0);
  [[unroll]] for (int i = 1; i < 3; ++i) {
    const int axis = (major + i) % 3;
    vec3 before = position, after = position;
    before[axis] = max(position[axis] - 1.0, 0.0);
    after[axis] = min(position[axis] + 1.0, float(frame.dimensions[axis] - 1));
    gradient[axis] = (depthToEye(after) - depthToEye(before)) / max(after[axis] - before[axis], 1.0);
  }
  gradient[major] = -(layerDepth + dot(gradient, direction)) / direction[major];
  return gradient;
}
