#version 460
// What the gather reads of occupied blocks, a thread for each block: extinction, and the source term, which
// is the light that the block sends to the eye per world unit (extinction times colour, plus emission unless that is kept apart).
// Without a phase function and surfaces the source term is computed once for all positions of the eye, until
// lights change: it is to be multiplied by 1 + dot(towards, direction to the eye), a unit vector in world
// space.
#extension GL_GOOGLE_include_directive : require
#include "gather_interface.h"
#include "block_color.glsl"
#include "depth_to_eye.glsl"
#include "lighting.glsl"

layout(local_size_x = kShadeThreads) in;
layout(scalar, push_constant) uniform Push { ShadePush push; };

const float kMinLight = 1e-4;  // smaller light is stored as this

ScatteredLight scatteredBy(Block block, float sigma, uint rank) {
  if (kAnyView) return scatteredLight(block, sigma, rank, vec3(0.0), sigma * push.meanLayer * float(block.edge));
  const vec3 direction = directionToEye(block.center);
  const float own = sigma * layerLength(direction) * float(layersOf(block, direction));
  return scatteredLight(block, sigma, rank, normalize(frame.indexToWorld * direction), own);
}

void main() {
  const uint number = gl_LocalInvocationID.x + kShadeThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x);
  if (number >= push.count) return;
  const uint rank = push.firstRank + number;
  const Block block = blockAt(WordStore(push.blocks).values[number]);
  // The part of the block outside of the volume is empty.
  const vec3 part = vec3(block.extent) / float(block.edge);
  const float inside = part.x * part.y * part.z;
  const float sigma = storedExtinction(rank);
  vec3 source = push.lightOnly != 0 ? vec3(1.0) : sigma * colorOf(block, rank);
  vec3 towards = vec3(0.0);
  if (kLit) {
    const ScatteredLight scattered = scatteredBy(block, sigma, rank);
    source *= scattered.light;
    towards = luminanceOf(source) / max(luminanceOf(scattered.light), 1e-37) * scattered.towards;
  }
  if (kEmits) {
    const vec3 emission = frame.emissionUnit * unpackLight(storedEmission(rank));
    if (push.emissionApart != 0)
      WordStore(push.extra).values[rank] = packLight(min(push.sourceScale * inside * emission, kMaxStored));
    else
      source += emission;
  }
  // A block without any light would count as one that has no source term.
  if (push.lightOnly != 0) source = max(source, kMinLight / push.sourceScale);
  const vec4 stored = min(vec4(push.sourceScale * source, push.extinctionScale * sigma) * (push.lightOnly != 0 ? 1.0 : inside), kMaxStored);
  PairStore(push.sources).values[rank] = uvec2(packLight(stored.rgb), packHalf2x16(vec2(stored.a, 0.0)));
  if (kLit && kAnyView)
    WordStore(push.extra).values[rank] = packSnorm4x8(vec4(towards / max(luminanceOf(source), 1e-37), 0.0));
}
