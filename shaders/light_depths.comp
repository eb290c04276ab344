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
layout(constant_id = 3) const bool kRows = false;    // whether rays are parallel and their planes contain the x axis, so that voxels of a row share rays

layout(local_size_x = kBrickQuadsThreads) in;
layout(scalar, push_constant) uniform Push { LightDepthsPush given; };
LightDepthsPush push;  // copied once, as lavapipe loads uniforms lane by lane
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

// The depth in front of a layer lacks half of the layer. For scalars the depth is that of the next voxel
// towards the light; the rest is integrated at the sample, from the change of the scalar there.
float depthOf(ivec3 cell) {
  cell = min(cell, push.level.dimensions - 1);
  const ivec3 extent = extentInside(cell, push.edge, push.voxels);
  const vec3 center = vec3(cell * push.edge) + 0.5 * vec3(extent - 1);
  vec3 toLight = lights[push.light].place;
  if (lights[push.light].atInfinity == 0) {
    toLight -= center - 0.5 * vec3(push.voxels - 1);
    if (dot(toLight, toLight) < kAtSource * kAtSource) toLight = vec3(0.0, 0.0, 1.0);
  }
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

uint packDepths(vec2 depths) { return packUnorm2x16(sqrt(clamp(depths / kOpaqueDepth, 0.0, 1.0))); }

// The depth of four rays of a plane, `stride` apart, times their weights. `last` is the plane's last ray.
float weightedDepth(uvec2 planes, int odd, uint ray, uint last, uint stride, vec4 weights) {
  vec4 roots;
  [[unroll]] for (int i = 0; i < 4; ++i) roots[i] = unpackUnorm2x16(rayCodes(planes, min(ray + i * stride, last)))[odd];
  return kOpaqueDepth * dot(roots * roots, weights);
}

// With kRows: the depths of a row of voxels. Neighbours are at most two rays apart, so that of the four rays along x between which a voxel
// lies, two at least are those of the voxel before it; each stands for four across x, which have the same weights for the whole row.
void storeRow(ivec3 first, uint pair) {
  const FaceRays fan = lights[push.light].fans[0];
  const ivec3 end = push.level.dimensions - 1, cell = min(first, end);
  const vec3 toLight = lights[push.light].place, size = abs(toLight);
  const vec3 layer = toLight / max(size.x, max(size.y, size.z));
  const vec3 position = vec3(cell) + (kScalars ? layer : vec3(0.0));
  const int plane = (int(round(position[fan.axis])) - fan.firstPlane) * fan.direction;
  const int kept = clamp(plane, 0, fan.planeCount - 1);
  const RayPlace at = rayPlace(fan, position, kept);
  const bool xFirst = fan.axis == 2;  // whether x is the first one of the face's sides
  const uint last = uint(fan.rayCount.x * fan.rayCount.y) - 1, rayRow = uint(fan.rayCount.x), alongX = xFirst ? 1 : rayRow, across = xFirst ? rayRow : 1;
  const vec4 weights = cubicWeights(xFirst ? at.within.y : at.within.x);
  const uvec2 planes = pairAddress(fan, kept / 2);
  const float ownLayer = kScalars ? 0.0 : 0.5 * length(push.indexToWorld * layer);
  vec4 near;  // the depths around the voxel, along x
  [[unroll]] for (int i = 0; i < 4; ++i) near[i] = weightedDepth(planes, at.odd, at.first + i * alongX, last, across, weights);
  uint next = at.first + 4 * alongX;
  float within = xFirst ? at.within.x : at.within.y, before = 0.0;
  for (int x = 0; x < kGatherBrickEdge; ++x) {
    const vec2 further = vec2(weightedDepth(planes, at.odd, next, last, across, weights),
                              weightedDepth(planes, at.odd, next + alongX, last, across, weights));
    if (x > 0 && first.x + x <= end.x) within += 1.0 / at.apart;
    const int moves = clamp(int(within), 0, 2);
    if (moves == 1) near = vec4(near.yzw, further.x);
    if (moves == 2) near = vec4(near.zw, further);
    within -= float(moves);
    next += moves * alongX;
    float depth = plane < 0 ? 0.0 : max(dot(near, cubicWeights(min(within, 1.0))), 0.0);
    if (!kScalars) depth += extinctionOf(min(first + ivec3(x, 0, 0), end)) * ownLayer;
    if ((x & 1) == 1) LightDepths(push.depths).pairs[pair + x / 2] = packDepths(vec2(before, depth));
    before = depth;
  }
}

void main() {
  push = given;
  const uint brick = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (brick >= push.count) return;
  const int row = int(gl_LocalInvocationIndex);
  const ivec3 first = ivec3(texelFetch(brickCells, int(push.firstBrick + brick)).xyz) +
                      ivec3(0, row % kGatherBrickEdge, row / kGatherBrickEdge);
  const uint pair = ((push.firstBrick + brick) * kGatherBrickBlocks + row * kGatherBrickEdge) / 2;
  if (kRows) {
    storeRow(first, pair);
    return;
  }
  for (int x = 0; x < kGatherBrickEdge; x += 2)
    LightDepths(push.depths).pairs[pair + x / 2] = packDepths(vec2(depthOf(first + ivec3(x, 0, 0)), depthOf(first + ivec3(x + 1, 0, 0))));
}
