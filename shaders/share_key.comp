#version 460
// The share of every block that a frame draws (engine/splatting/shares.h), as the key by which the list of blocks is sorted, and the
// number of drawn blocks of each share.
#extension GL_GOOGLE_include_directive : require
#include "share_interface.h"
#define OCCUPANCY_BINDING 3
#include "occupancy.glsl"

layout(local_size_x = kSortThreads) in;
layout(scalar, push_constant) uniform Push { ShareKeyPush push; };
layout(scalar, binding = 0) readonly buffer Frame { ShareFrame frame; };
layout(scalar, binding = 1) readonly buffer Blocks { uint blocks[]; };
layout(scalar, binding = 2) readonly buffer Chunks { ChunkArguments chunks[]; };
layout(scalar, binding = 4) readonly buffer Shares { uint shares[]; };
layout(scalar, binding = 5) writeonly buffer Count { uint count; };
layout(scalar, binding = 6) writeonly buffer Keys { uint keys[]; };
layout(scalar, binding = 7) writeonly buffer Values { uint values[]; };
layout(scalar, binding = 8) buffer ShareCounts { uint shareCounts[]; };

// One digit of the sort, one thread and one share each.
shared uint histogram[kSortDigits];

uint shareOf(uint address) {
  int level = 0;
  while (level + 1 < frame.levelCount && address >= frame.levels[level + 1].first) ++level;
  const int covering = min(level + frame.chunkLevels, frame.levelCount - 1);
  const ivec3 cell = cellAt(frame.levels[level], address) >> (covering - level);
  const BlockLevel chunkBlocks = frame.levels[covering];
  return shares[frame.firstChunks[level] + rankAt(chunkBlocks, blockAddress(chunkBlocks, cell)) - chunkBlocks.firstRank];
}

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint i = group * kSortThreads + gl_LocalInvocationIndex;
  if (i == 0) {
    uint total = 0;
    for (uint chunk = 0; chunk < push.chunkCount; ++chunk) total += chunks[chunk].splatCount;
    count = total;
  }
  histogram[gl_LocalInvocationIndex] = 0;
  barrier();
  const uint chunk = i / kSplatsPerChunk;
  if (chunk < push.chunkCount && i - chunk * kSplatsPerChunk < chunks[chunk].splatCount) {
    const uint share = shareOf(blocks[i]);
    keys[i] = share;
    values[i] = blocks[i];
    atomicAdd(histogram[share], 1);
  }
  barrier();
  const uint found = histogram[gl_LocalInvocationIndex];
  if (found > 0) atomicAdd(shareCounts[gl_LocalInvocationIndex], found);
}
