#version 460
// Marks the occupied blocks of levels of the octree, each from the level below; a part is a word of blocks.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

#define LEVEL_STEPS_BINDING 1
#include "level_steps.glsl"

layout(local_size_x = kOccupancyThreads) in;
layout(scalar, push_constant) uniform Push { OccupiedBlocksPush push; };
layout(scalar, binding = 0) LEVEL_ACCESS buffer Occupancy { OccupancyWord occupancy[]; };

// Two children that are neighbours in x are in the same word, because rows begin at even indices.
bool isOccupied(ivec3 cell) {
  for (int row = 0; row < 4; ++row) {
    const ivec3 child = 2 * cell + ivec3(0, row & 1, row >> 1);
    if (any(greaterThanEqual(child, current.child.dimensions))) continue;
    const uint address = blockAddress(current.child, child);
    if ((occupancy[address / kBlocksPerWord].mask >> (address % kBlocksPerWord) & 3u) != 0) return true;
  }
  return false;
}

uint partCount() { return current.parentWords; }

void makePart(uint word) {
  const BlockLevel parent = current.parent;
  uint mask = 0;
  for (uint i = 0; i < kBlocksPerWord; ++i) {
    const ivec3 cell = cellAt(parent, parent.first + kBlocksPerWord * word + i);
    if (all(lessThan(cell, parent.dimensions)) && isOccupied(cell)) mask |= 1u << i;
  }
  occupancy[parent.first / kBlocksPerWord + word].mask = mask;
}

void main() { computeLevels(push.levels, kOccupancyThreads); }
