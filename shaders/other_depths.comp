#version 460
// Adds the optical depths that another volume has between a light and the centres of all blocks of a volume's bricks to the codes of
// depths that light_depths.comp made. A workgroup for each brick, a thread for each row of blocks.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_interface.h"
#include "blocks.glsl"

// Whether the rays hold depths of positions (scalars), or those in front of layers.
layout(constant_id = 0) const bool kScalars = false;

layout(local_size_x = kBrickQuadsThreads) in;
layout(scalar, push_constant) uniform Push { OtherDepthsPush push; };
#define RAY_DEPTHS_BINDING 3
#include "ray_lookup.glsl"
layout(binding = 0) uniform utextureBuffer brickCells;  // position of each brick's first block, in blocks: x, y, z
layout(scalar, binding = 1) readonly buffer Other { OtherVolume other; };
layout(scalar, binding = 2) readonly buffer Lights { Light lights[]; };  // of the other volume
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LightDepths { uint pairs[]; };

const float kAtSource = 1e-3;  // in voxels: at a smaller distance from a light the direction is undefined

// The depth between the light and a position in the index space of the other volume: that at the end of what the way to the light has of
// its box, between the rays' depths on the planes in front and behind.
float depthAt(vec3 position) {
  const Light light = lights[push.light];
  vec3 toLight = light.place;
  if (light.atInfinity == 0) {
    toLight -= position - 0.5 * vec3(other.dimensions - 1);
    if (dot(toLight, toLight) < kAtSource * kAtSource) return 0.0;
  }
  float begin = 0.0, end = light.atInfinity == 0 ? 1.0 : 3e38;
  for (int c = 0; c < 3; ++c) {
    const float perUnit = 1.0 / (abs(toLight[c]) < 1e-12 ? 1e-12 : toLight[c]);
    const float a = (-0.5 - position[c]) * perUnit, b = (float(other.dimensions[c]) - 0.5 - position[c]) * perUnit;
    begin = max(begin, min(a, b));
    end = min(end, max(a, b));
  }
  if (begin >= end) return 0.0;
  position += begin * toLight;
  const FaceRays fan = light.fans[fanIndex(-toLight)];
  const vec3 layer = toLight / max(abs(toLight[fan.axis]), 1e-12);
  if (!kScalars) position -= 0.5 * layer;  // depths are those half a layer nearer to the light than their planes
  const float place = position[fan.axis];
  const float toPlane = layer[fan.axis] > 0.0 ? ceil(place) - place : place - floor(place);
  const vec3 near = position + toPlane * layer;
  const int last = fan.firstPlane + fan.direction * (fan.planeCount - 1);
  const float before = depthUpTo(fan, near);
  // Behind the last plane the depth grows as in front of it.
  const bool isLast = (int(round(near[fan.axis])) - last) * fan.direction >= 0;
  if (isLast) return before + toPlane * max(before - depthUpTo(fan, near + layer), 0.0);
  return mix(before, depthUpTo(fan, near - layer), toPlane);
}

float depthOfBlock(ivec3 cell) {
  const ivec3 extent = extentInside(cell, push.edge, push.voxels);
  return depthAt(other.toOther * (vec3(cell * push.edge) + 0.5 * vec3(extent - 1)) + other.offset);
}

void main() {
  const uint brick = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (brick >= push.count) return;
  const int row = int(gl_LocalInvocationIndex);
  const ivec3 last = (push.voxels - 1) / push.edge;
  const ivec3 first = ivec3(texelFetch(brickCells, int(push.firstBrick + brick)).xyz) +
                      ivec3(0, row % kGatherBrickEdge, row / kGatherBrickEdge);
  const uint pair = ((push.firstBrick + brick) * kGatherBrickBlocks + row * kGatherBrickEdge) / 2;
  for (int x = 0; x < kGatherBrickEdge; x += 2) {
    const vec2 roots = unpackUnorm2x16(LightDepths(push.depths).pairs[pair + x / 2]);
    const vec2 behind = vec2(depthOfBlock(min(first + ivec3(x, 0, 0), last)), depthOfBlock(min(first + ivec3(x + 1, 0, 0), last)));
    LightDepths(push.depths).pairs[pair + x / 2] = packUnorm2x16(sqrt(clamp(roots * roots + behind / kOpaqueDepth, 0.0, 1.0)));
  }
}
