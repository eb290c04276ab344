#version 460
// Optical depth from the centres of all blocks of bricks to a light, from the light's rays: the gather's
// samples interpolate it. A workgroup for each brick, a thread for each row of blocks.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_interface.h"
#include "blocks.glsl"
#include "rank.glsl"

// Whether rays hold depths of positions (scalars), or those in front of layers.
layout(constant_id = 0) const bool kScalars = false;
layout(constant_id = 2) const bool kVoxels = false;  // whether blocks are voxels

layout(local_size_x = kBrickQuadsThreads) in;
layout(scalar, push_constant) uniform Push { LightDepthsPush push; };
#define RAY_DEPTHS_BINDING 3
#include "ray_lookup.glsl"
layout(binding = 0) uniform utextureBuffer brickCells;  // position of each brick's first block, in blocks: x, y, z
layout(binding = 1) uniform utextureBuffer occupancy;   // OccupancyWord
layout(scalar, binding = 2) readonly buffer Lights { Light lights[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Extinctions { float values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer LightDepths { uint pairs[]; };

const float kAtSource = 1e-3;  // in voxels: at a smaller distance from a light the direction is undefined

float extinctionOf(ivec3 cell) {
  const uint address = blockAddress(push.level, cell);
  const uvec2 word = texelFetch(occupancy, int(address / kBlocksPerWord)).xy;
  const int bit = int(address % kBlocksPerWord);
  if ((word.x >> bit & 1u) == 0) return 0.0;
  return Extinctions(push.extinction).values[push.level.firstRank + rankIn(word, bit)];
}

// On the side from which rays come, there is nothing in front of the first plane.
float depthUpTo(FaceRays fan, vec3 position) {
  const int plane = (int(round(position[fan.axis])) - fan.firstPlane) * fan.direction;
  return plane < 0 ? 0.0 : rayDepth(fan, position).x;
}

// The depth in front of a layer lacks half of the layer. For scalars the depth is that of the next voxel
// towards the light; the rest is integrated at the sample, from the change of the scalar there.
float depthOf(ivec3 cell) {
  cell = min(cell, push.level.dimensions - 1);
  const ivec3 extent = extentInside(cell, push.edge, push.voxels);
  const vec3 center = vec3(cell * push.edge) + 0.5 * vec3(extent - 1);
  vec3 toLight = lights[push.light].place;
  if (lights[push.light].atInfinity == 0) toLight -= center - 0.5 * vec3(push.voxels - 1);
  if (dot(toLight, toLight) < kAtSource * kAtSource) toLight = vec3(0.0, 0.0, 1.0);
  const vec3 size = abs(toLight);
  const vec3 layer = toLight / max(size.x, max(size.y, size.z));
  const FaceRays fan = lights[push.light].fans[fanIndex(-toLight)];
  if (kVoxels && kScalars) return depthUpTo(fan, center + layer);
  float found;
  if (kVoxels)
    found = depthUpTo(fan, center);
  else
    found = extent[fan.axis] % 2 == 1 ? depthUpTo(fan, center)
                                      : 0.5 * (depthUpTo(fan, center + 0.5 * layer) + depthUpTo(fan, center - 0.5 * layer));
  return kScalars ? found : found + 0.5 * extinctionOf(cell) * length(push.indexToWorld * layer);
}

void main() {
  const uint brick = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (brick >= push.count) return;
  const int row = int(gl_LocalInvocationIndex);
  const ivec3 first = ivec3(texelFetch(brickCells, int(push.firstBrick + brick)).xyz) +
                      ivec3(0, row % kGatherBrickEdge, row / kGatherBrickEdge);
  const uint pair = ((push.firstBrick + brick) * kGatherBrickBlocks + row * kGatherBrickEdge) / 2;
  for (int x = 0; x < kGatherBrickEdge; x += 2) {
    const vec2 depths = vec2(depthOf(first + ivec3(x, 0, 0)), depthOf(first + ivec3(x + 1, 0, 0)));
    LightDepths(push.depths).pairs[pair + x / 2] = packUnorm2x16(sqrt(clamp(depths / kOpaqueDepth, 0.0, 1.0)));
  }
}
