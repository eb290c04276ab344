#version 460
// Second of three passes that list the samples of rough cells, one workgroup: turns the workgroups' counts into offsets (exclusive sum), and
// the total into the sizes of the dispatches that march them.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "gather_interface.h"

layout(local_size_x = kScanThreads) in;
layout(scalar, push_constant) uniform Push { SamplesPush push; };
layout(scalar, binding = 0) buffer GroupCounts { uint groupCounts[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer SampleList { SampleListHead head; };

#define COUNT_THREADS kScanThreads
#include "count_before.glsl"

shared uint total;

void main() {
  const uint thread = gl_LocalInvocationIndex, groups = uint(push.groups), stretch = (groups + kScanThreads - 1) / kScanThreads;
  const uint first = min(thread * stretch, groups), end = min(first + stretch, groups);
  uint sum = 0;
  for (uint i = first; i < end; ++i) sum += groupCounts[i];
  uint offset = countBefore(thread, sum);
  if (thread == kScanThreads - 1) total = offset + sum;
  barrier();
  for (uint i = first; i < end; ++i) {
    const uint count = groupCounts[i];
    groupCounts[i] = offset;
    offset += count;
  }
  SampleList list = SampleList(push.list);
  if (thread == 0) list.head.count = total;
  if (thread < kSampleRanges) {
    const uint samplesOfARow = uint(push.groupsOfARow * kGatherTile * kGatherTile), rows = (total + samplesOfARow - 1) / samplesOfARow;
    const uint before = min(thread * uint(push.rowsOfARange), rows);
    list.head.ranges[thread] = DispatchSize(uint(push.groupsOfARow), min(rows - before, uint(push.rowsOfARange)), 1);
  }
}
