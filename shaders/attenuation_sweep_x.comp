#version 460
// The attenuation table for the directions +x and -x: Subr et al. 2007, Section 3.1, Eq. 5. A thread a row.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "stored_codes.glsl"

layout(constant_id = 1) const int kStepX = 1;  // step of the march: 1 or -1

layout(constant_id = 2) const bool kOfPart = false;  // as in attenuation_sweep.comp

layout(local_size_x = kSweepThreads) in;
layout(scalar, push_constant) uniform Push { SweepPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer EntryDepths { float values[]; };
layout(binding = 0) uniform textureBuffer extinction;

void main() {
  const int row = int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kSweepThreads);
  if (row >= push.lineCount) return;
  const int quads = push.rowPitch / 4;
  const int first = push.marchStart / 4 + row * quads;
  // Padding before the first voxel adds nothing.
  float depth = kOfPart ? EntryDepths(push.entry.depths).values[push.entry.rowFace + row] : 0.0;
  for (int i = 0; i < quads; ++i) {
    const int quad = first + (kStepX > 0 ? i : quads - 1 - i);
    const vec4 sigma = texelFetch(extinction, quad - push.slab.firstQuad);
    vec4 depths;
    [[unroll]] for (int i4 = 0; i4 < 4; ++i4) {
      const int c = kStepX > 0 ? i4 : 3 - i4;
      depths[c] = depth;
      depth += sigma[c] * push.stepLength;
    }
    storeCodes(quad, depths);
  }
}
