#version 460
// Optical depth from the centres of all voxels of some planes to a light, from the light's rays on these planes: what light_depths.comp
// computes, for planes of a volume that is not on the device as a whole, in the bricks whose light is kept. A thread writes two voxels of a row.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_interface.h"
layout(scalar, push_constant) uniform Push { LightPlanesPush push; };
#define RAY_DEPTHS_BINDING 4
#include "ray_lookup.glsl"

// Whether rays hold depths of positions (scalars), or those in front of layers.
layout(constant_id = 0) const bool kScalars = false;

layout(local_size_x = kLightPlanesThreads) in;
layout(scalar, binding = 0) uniform Planes { LightPlanes planes; };
layout(binding = 1) uniform samplerBuffer extinction;  // of the slab's voxels
// By plane, brick and row. kOtherFan where the voxel is not on this face.
layout(scalar, binding = 2) writeonly buffer Codes { uint codes[]; };
layout(scalar, binding = 3) readonly buffer Bricks { ivec2 bricks[]; };  // places on the sides, in bricks

const float kAtSource = 1e-3;  // in voxels: at a smaller distance from a light the direction is undefined

uint codeOf(ivec2 side, int plane) {
  const int axis = planes.fan.axis;
  vec3 center;
  center[axis] = float(planes.fan.firstPlane + planes.fan.direction * plane);
  center[(axis + 1) % 3] = float(side.x);
  center[(axis + 2) % 3] = float(side.y);
  vec3 toLight = planes.place - (planes.atInfinity == 0 ? center : vec3(0.0));
  if (dot(toLight, toLight) < kAtSource * kAtSource) toLight = vec3(0.0, 0.0, 1.0);
  if (planes.atInfinity == 0 && fanIndex(-toLight) != planes.fanIndex) return kOtherFan;
  const vec3 size = abs(toLight);
  const vec3 layer = toLight / max(size.x, max(size.y, size.z));
  float depth;
  if (kScalars) {
    depth = depthUpTo(planes.fan, center + layer);
  } else {
    const int voxel = planes.slab.origin + plane * planes.slab.planeStride + side.x * planes.slab.strideA + side.y * planes.slab.strideB;
    depth = depthUpTo(planes.fan, center) + 0.5 * texelFetch(extinction, voxel).x * length(planes.indexToWorld * layer);
  }
  return min(uint(sqrt(clamp(depth / kOpaqueDepth, 0.0, 1.0)) * 65535.0 + 0.5), kOtherFan - 1);
}

void main() {
  const int place = int(gl_LocalInvocationID.x + kLightPlanesThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  const int perBrick = kLightBrickEdge * kLightBrickEdge / 2, brick = place / perBrick, pair = place % perBrick;
  if (brick >= push.brickCount) return;
  const int plane = push.firstPlane + int(gl_WorkGroupID.z);
  // Beyond the volume's box nobody reads what is written.
  const ivec2 side = min(kLightBrickEdge * bricks[push.firstBrick + brick] + ivec2(2 * pair % kLightBrickEdge, 2 * pair / kLightBrickEdge), planes.sides - 1);
  const uint second = codeOf(min(side + ivec2(1, 0), planes.sides - 1), plane);
  codes[push.firstCode + place + perBrick * push.brickCount * int(gl_WorkGroupID.z)] = codeOf(side, plane) | second << 16;
}
