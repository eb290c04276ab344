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
layout(constant_id = 2) const bool kAtInfinity = false;  // whether the light is at infinity

layout(local_size_x = kBrickQuadsThreads) in;
layout(scalar, push_constant) uniform Push { OtherDepthsPush push; };
#define RAY_DEPTHS_BINDING 3
#include "ray_lookup.glsl"
layout(binding = 0) uniform utextureBuffer brickCells;  // position of each brick's first block, in blocks: x, y, z
layout(scalar, binding = 1) readonly buffer Other { OtherVolume other; };
layout(scalar, binding = 2) readonly buffer Lights { Light lights[]; };  // of the other volume
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LightDepths { uint pairs[]; };

const float kAtSource = 1e-3;  // in voxels: at a smaller distance from a light the direction is undefined

// The vector from a position to the light, of a light at infinity its direction, in voxels of the other volume.
vec3 toLightFrom(vec3 position) {
  const vec3 place = lights[push.light].place;
  return kAtInfinity ? place : place - (position - 0.5 * vec3(other.dimensions - 1));
}

// The part of the segment from a position to the light that is in the box of the other volume, as multiples of `toLight`; empty if x >= y.
vec2 segmentInBox(vec3 position, vec3 toLight) {
  vec2 range = vec2(0.0, kAtInfinity ? 3e38 : 1.0);
  for (int c = 0; c < 3; ++c) {
    const float perUnit = 1.0 / (abs(toLight[c]) < 1e-12 ? 1e-12 : toLight[c]);
    const float a = (-0.5 - position[c]) * perUnit, b = (float(other.dimensions[c]) - 0.5 - position[c]) * perUnit;
    range = vec2(max(range.x, min(a, b)), min(range.y, max(a, b)));
  }
  return range;
}

// The depths on two neighbouring planes of a fan, of the ray through a position on the first of them. Planes in front of the fan have none.
vec2 depthsOnPlanes(FaceRays fan, vec3 position, ivec2 planes) {
  const RayPlace at = rayPlace(fan, position, planes.x);
  const ivec2 kept = clamp(planes, ivec2(0), ivec2(fan.planeCount - 1));
  const uvec2 first = pairAddress(fan, kept.x / 2), second = pairAddress(fan, kept.y / 2);
  const vec4 weightsX = cubicWeights(at.within.x), weightsY = cubicWeights(at.within.y);
  uint ray = at.first;
  vec2 sum = vec2(0.0);
  [[unroll]] for (int j = 0; j < 4; ++j) {
    vec4 onFirst, onSecond;
    [[unroll]] for (int i = 0; i < 4; ++i) {
      onFirst[i] = unpackUnorm2x16(rayCodes(first, ray + i))[kept.x & 1];
      onSecond[i] = unpackUnorm2x16(rayCodes(second, ray + i))[kept.y & 1];
    }
    sum += weightsY[j] * vec2(dot(onFirst * onFirst, weightsX), dot(onSecond * onSecond, weightsX));
    ray += uint(fan.rayCount.x);
  }
  return mix(kOpaqueDepth * max(sum, vec2(0.0)), vec2(0.0), lessThan(planes, ivec2(0)));
}

// The depth between the light and a position in the index space of the other volume: that at the end of what the way to the light has of
// its box, between the rays' depths on the planes in front and behind.
float depthAt(vec3 position, FaceRays fan) {
  const vec3 toLight = toLightFrom(position);
  const vec2 way = segmentInBox(position, toLight);
  if (way.x >= way.y || dot(toLight, toLight) < kAtSource * kAtSource || fan.planeCount == 0) return 0.0;
  position += way.x * toLight;
  const vec3 layer = toLight / max(abs(toLight[fan.axis]), 1e-12);
  if (!kScalars) position -= 0.5 * layer;  // depths are those half a layer nearer to the light than their planes
  const float place = position[fan.axis];
  const float toPlane = layer[fan.axis] > 0.0 ? ceil(place) - place : place - floor(place);
  const vec3 near = position + toPlane * layer;
  const int plane = (int(round(near[fan.axis])) - fan.firstPlane) * fan.direction;
  // Behind the last plane the depth grows as in front of it.
  const bool isLast = plane >= fan.planeCount - 1;
  const vec2 depths = depthsOnPlanes(fan, near, ivec2(plane, isLast ? plane - 1 : plane + 1));
  return isLast ? depths.x + toPlane * max(depths.x - depths.y, 0.0) : mix(depths.x, depths.y, toPlane);
}

// The center of a block in the index space of the other volume.
vec3 centerOf(ivec3 cell) {
  const ivec3 extent = extentInside(cell, push.edge, push.voxels);
  return other.toOther * (vec3(cell * push.edge) + 0.5 * vec3(extent - 1)) + other.offset;
}

// Whether the segment to the light passes through the box of the other volume.
bool mayBeShadowed(vec3 position) {
  const vec2 way = segmentInBox(position, toLightFrom(position));
  return way.x < way.y;
}

FaceRays fanAt(vec3 position) { return lights[push.light].fans[kAtInfinity ? 0 : fanIndex(-toLightFrom(position))]; }

void main() {
  const uint brick = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (brick >= push.count) return;
  const int row = int(gl_LocalInvocationIndex);
  const ivec3 last = (push.voxels - 1) / push.edge;
  const ivec3 first = ivec3(texelFetch(brickCells, int(push.firstBrick + brick)).xyz) +
                      ivec3(0, row % kGatherBrickEdge, row / kGatherBrickEdge);
  const uint pair = ((push.firstBrick + brick) * kGatherBrickBlocks + row * kGatherBrickEdge) / 2;
  FaceRays fan;
  if (kAtInfinity) fan = fanAt(vec3(0.0));
  int x = 0;
  do {
    // The search is a loop of its own: lavapipe executes a branch even if no lane takes it.
    vec3 even, odd;
    bool searches = x < kGatherBrickEdge;
    do {
      if (searches) {
        even = centerOf(min(first + ivec3(x, 0, 0), last));
        odd = centerOf(min(first + ivec3(x + 1, 0, 0), last));
        searches = !mayBeShadowed(even) && !mayBeShadowed(odd);
        if (searches) x += 2;
        searches = searches && x < kGatherBrickEdge;
      }
    } while (searches);
    if (x < kGatherBrickEdge) {
      const vec2 behind = vec2(depthAt(even, kAtInfinity ? fan : fanAt(even)), depthAt(odd, kAtInfinity ? fan : fanAt(odd)));
      const vec2 roots = unpackUnorm2x16(LightDepths(push.depths).pairs[pair + x / 2]);
      LightDepths(push.depths).pairs[pair + x / 2] = packUnorm2x16(sqrt(clamp(roots * roots + behind / kOpaqueDepth, 0.0, 1.0)));
      x += 2;
    }
  } while (x < kGatherBrickEdge);
}
