#version 460
// Finds which volumes of a frame each ray meets. Stores the sums of rays that meet none.
#extension GL_GOOGLE_include_directive : require
#include "gather_samples.glsl"

layout(scalar, binding = 1) uniform Merge { MergeFrame merge; };
layout(binding = 2, rgba32f) writeonly uniform imageBuffer colorEnergy;
layout(binding = 3, r32f) writeonly uniform imageBuffer distances;

// Interpolation reaches a voxel beyond the outermost centres.
const float kAround = 1.0 + 1.0 / 1024.0;

void main() {
  ivec2 index = sampleOfThread();
  if (any(greaterThanEqual(index, frame.seenExtent))) return;
  index += frame.firstSeen;
  const vec3 position = samplePosition(frame.firstSample, frame.pitch, index);
  uint met = 0;
  for (int v = 0; v < merge.volumes; ++v) {
    const MergedBox box = merge.boxes[v];
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
  if (met != 0) return;
  const int place = index.x + index.y * frame.samples.x;
  imageStore(colorEnergy, place, vec4(0.0));
  imageStore(distances, place, vec4(0.0));
}
