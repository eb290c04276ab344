#version 460
// Finds which volumes of a frame each ray meets.
#extension GL_GOOGLE_include_directive : require
#include "gather_samples.glsl"

// Interpolation reaches a voxel beyond the outermost centres.
const float kAround = 1.0 + 1.0 / 1024.0;

void main() {
  ivec2 index = sampleOfThread();
  if (any(greaterThanEqual(index, frame.seenExtent))) return;
  index += frame.firstSeen;
  const vec3 position = samplePosition(frame.firstSample, frame.pitch, index);
  MergeConstants merge = MergeConstants(push.merge);
  uint met = 0;
  for (int v = 0; v < merge.values.volumes; ++v) {
    const MergedBox box = merge.values.boxes[v];
    float begin = 0.0, end = 3e38;
    for (int c = 0; c < 3; ++c) {
      const float origin = dot(box.origin[c], position), direction = dot(box.direction[c], position);
      const float perUnit = 1.0 / (abs(direction) < 1e-20 ? 1e-20 : direction);
      const float a = (-kAround - origin) * perUnit, b = (float(box.dimensions[c] - 1) + kAround - origin) * perUnit;
      begin = max(begin, min(a, b));
      end = min(end, max(a, b));
    }
    if (begin <= end) met |= 1u << v;
  }
  MergedRays(push.rays).values[slotOfThread()] = met;
}
