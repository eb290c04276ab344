#version 460
// What cells send out per world unit: what they scatter, by moments of direction, and what they emit.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scattering_interface.h"

layout(constant_id = 0) const int kChannels = 1;
layout(constant_id = 1) const bool kFlux = false;

layout(local_size_x = kScatteringThreads) in;
layout(scalar, push_constant) uniform Push { ScatteringSourcePush push; };
layout(binding = 0) uniform textureBuffer medium;
layout(binding = 1) uniform textureBuffer vectors;
layout(binding = 2) uniform textureBuffer direct;
layout(binding = 3, rgba32f) writeonly uniform imageBuffer sources;  // by moment and cell

void main() {
  const int cell = int(gl_LocalInvocationID.x + kScatteringThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  if (cell >= push.count) return;
  const int moments = kFlux ? 4 : 1, planes = kChannels * moments;
  [[unroll]] for (int moment = 0; moment < 4; ++moment) {
    if (moment >= moments) continue;
    vec4 source = vec4(0.0);
    [[unroll]] for (int channel = 0; channel < kChannels; ++channel) {
      const int place = (moment * kChannels + channel) * push.count + cell;
      float light = 0.0;
      if (push.from >= 0) light += texelFetch(vectors, push.from * planes * push.count + place).x;
      if (push.direct >= 0) light += texelFetch(direct, place).x;
      source[channel] = texelFetch(medium, (push.scattering + channel) * push.count + cell).x * light;
      if (push.emission >= 0 && moment == 0)
        source[channel] += texelFetch(medium, (push.emission + channel) * push.count + cell).x;
    }
    imageStore(sources, moment * push.count + cell, source);
  }
}
