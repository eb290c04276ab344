// The ray of a sample of the lattice.
#ifndef GATHER_RAY_GLSL
#define GATHER_RAY_GLSL
#include "gather_frame.glsl"
#include "major_axis.glsl"

// The sample's position relative to the image's middle, in pixels: (1, x, y).
vec3 samplePosition(vec2 firstSample, float pitch, ivec2 index) { return vec3(1.0, firstSample + pitch * vec2(index)); }

// The component of a position's ray along each axis.
vec3 alongAxes(vec3 position) {
  return vec3(dot(frame.axes[0].along, position), dot(frame.axes[1].along, position), dot(frame.axes[2].along, position));
}

// The axis along which a ray marches; rays that miss the volume have the main axis.
int marchAxis(vec3 position, vec3 along) {
  const vec3 size = abs(along);
  const bool seen = all(greaterThanEqual(position.yz, frame.seenLow)) && all(lessThanEqual(position.yz, frame.seenHigh));
  const bool isMain = size[frame.mainAxis] >= kMinAlong * max(size.x, max(size.y, size.z));
  return !seen || isMain ? frame.mainAxis : majorAxis(along);
}

#endif
