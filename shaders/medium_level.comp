#version 460
// Computes levels of the octree, each from the one below; a part is an occupied block. Extinction is the mean
// over the voxels inside the volume, which conserves optical depth; colour is the mean weighted by the
// children's opacities; emission is a mean like extinction.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "opacity.glsl"
#include "packed_light.glsl"

layout(constant_id = 0) const bool kColors = false;      // whether there is more than one colour
layout(constant_id = 1) const bool kFromVoxels = false;  // whether the children are voxels
layout(constant_id = 2) const bool kEmits = false;

layout(local_size_x = kLevelThreads) in;
layout(scalar, push_constant) uniform Push { MediumLevelPush push; };
#define LEVEL_STEPS_BINDING 1
#define OCCUPANCY_BINDING 0
#define STORES push.stores
#include "level_steps.glsl"
#define STORES_ACCESS LEVEL_ACCESS
#include "stored_block.glsl"

vec3 childColor(uint rank) {
  if (kFromVoxels) return unpackLight(storedColor(rank));
  return unpackColor(storedBlockColor(rank - push.firstColor));
}

uint partCount() { return current.parentCount; }

void makePart(uint i) {
  const ivec3 cell = parentCell(i);
  const vec3 inside = vec3(extentInside(cell, 2 * current.childEdge, push.voxels));
  const float childLength = push.voxelLength * float(current.childEdge);
  float mean = 0.0, opacity = 0.0;
  vec3 color = vec3(0.0), light = vec3(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 child = 2 * cell + ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    if (any(greaterThanEqual(child, current.child.dimensions))) continue;
    const vec3 part = vec3(extentInside(child, current.childEdge, push.voxels)) / inside;
    const float share = part.x * part.y * part.z;
    const uint address = blockAddress(current.child, child);
    if (!isOccupied(address)) continue;
    const uint rank = rankAt(current.child, address);
    const float sigma = storedExtinction(rank);
    mean += share * sigma;
    if (kEmits) light += share * unpackLight(storedEmission(rank));
    if (kColors) {
      const float weight = share * opacityOf(sigma * childLength);
      opacity += weight;
      color += weight * childColor(rank);
    }
  }
  const uint rank = current.parent.firstRank + i;
  FloatStore(push.stores.extinction).values[rank] = kEmits && mean == 0.0 ? 0.0 : max(mean, kMinExtinction);
  if (kEmits) WordStore(push.stores.emission).values[rank] = packLight(light);
  if (kColors)
    PairStore(push.stores.blockColors).values[rank - push.firstColor] = packColor(opacity > 0.0 ? color / opacity : vec3(0.0));
}

void main() { computeLevels(push.levels, kLevelThreads); }
