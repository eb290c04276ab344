#version 460
// Draws a splat as a point sprite, or as a quad if the device has no points of its size. Vertices are fetched
// from the records.
#extension GL_GOOGLE_include_directive : require
#include "frame_interface.h"

layout(constant_id = 0) const bool kQuads = false;

layout(scalar, push_constant) uniform Push { SplatPush push; };
layout(scalar, binding = 0) readonly buffer Splats { Splat splats[]; };

layout(location = 0) flat out vec4 colorEnergy;
layout(location = 1) flat out vec4 conicDepth;      // conic, optical depth
layout(location = 2) flat out vec3 centerDistance;  // centre, distance
layout(location = 3) flat out vec3 depthToEye;      // at the centre, its gradient

void main() {
  const Splat splat = splats[kQuads ? gl_InstanceIndex : gl_VertexIndex];
  colorEnergy = splat.colorEnergy;
  conicDepth = vec4(splat.conic, splat.opticalDepth);
  centerDistance = vec3(splat.center, splat.distance);
  depthToEye = splat.depthToEye;

  const float size = 2.0 * max(splat.halfExtent.x, splat.halfExtent.y);
  vec2 position = splat.center;
  if (kQuads) {
    const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0;
    // A splat near the eye may reach far beyond the image.
    position = clamp(position + corner * splat.halfExtent, -0.5 * push.viewportSize, 0.5 * push.viewportSize);
  }
  gl_Position = vec4(position / (0.5 * push.viewportSize), 0.0, 1.0);
  if (size == 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside the clip volume
  gl_PointSize = max(size, 1.0);
}
