#version 460
// Second pass of the list of occupied blocks, one workgroup: turns counts into offsets (exclusive sum), and
// the total into the arguments of each chunk's dispatch and draw.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(local_size_x = kScanThreads) in;
layout(scalar, push_constant) uniform Push { CompactPush push; };
layout(scalar, binding = 0) buffer GroupCounts { uint groupCounts[]; };
layout(scalar, binding = 1) writeonly buffer Chunks { ChunkArguments chunks[]; };

shared uint sums[kScanThreads];

void main() {
  const uint thread = gl_LocalInvocationIndex;
  const uint perThread = (push.groupCount + kScanThreads - 1) / kScanThreads;
  const uint first = min(thread * perThread, push.groupCount);
  const uint last = min(first + perThread, push.groupCount);
  uint sum = 0;
  for (uint i = first; i < last; ++i) sum += groupCounts[i];
  sums[thread] = sum;
  barrier();

  uint offset = 0;
  uint total = 0;
  for (uint i = 0; i < kScanThreads; ++i) {
    offset += i < thread ? sums[i] : 0;
    total += sums[i];
  }
  for (uint i = first; i < last; ++i) {
    const uint count = groupCounts[i];
    groupCounts[i] = offset;
    offset += count;
  }

  if (thread == 0) groupCounts[push.groupCount] = total;

  for (uint chunk = thread; chunk < push.chunkCount; chunk += kScanThreads) {
    const uint start = min(chunk * kSplatsPerChunk, total);
    const uint count = min(total - start, uint(kSplatsPerChunk));
    chunks[chunk] = ChunkArguments((count + kSplatThreads - 1) / kSplatThreads, 1, 1,  //
                                                     count, start,                                       //
                                                     count, 1, 0, 0,                                     //
                                                     4, count, 0, 0);
  }
}
