#version 460
// The solution as it is looked up (scattered_light.glsl): a texel for each moment of a cell.
#extension GL_GOOGLE_include_directive : require
#include "scattering_interface.h"

layout(local_size_x = kScatteringThreads) in;
layout(scalar, push_constant) uniform Push { ScatteringTexelsPush push; };
layout(binding = 0, scalar) readonly restrict buffer Vectors { float vectors[]; };
layout(binding = 1, scalar) writeonly restrict buffer Texels { vec4 texels[]; };

void main() {
  const int cell = int(gl_LocalInvocationID.x + kScatteringThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  if (cell >= push.count) return;
  for (int moment = 0; moment < push.moments; ++moment) {
    vec3 light;
    [[unroll]] for (int c = 0; c < 3; ++c)
      light[c] = vectors[(moment * push.channels + (push.channels == 1 ? 0 : c)) * push.count + cell];
    texels[cell * push.moments + moment] = vec4(light, 0.0);
  }
}
