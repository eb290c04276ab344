#version 460
// Third of three passes that list the samples of rough cells: each workgroup writes those of its cells, so that the list has the same order
// every time.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#define ROUGHNESS_BINDING 1
#include "gather_rough_cells.glsl"
#define COUNT_THREADS (kGatherTile * kGatherTile)
#include "count_before.glsl"

layout(scalar, binding = 2) readonly buffer GroupOffsets { uint groupOffsets[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer SampleList { SampleListHead head; uint samples[]; };
layout(push_constant, scalar) uniform Push { SamplesPush push; };

void main() {
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  const bvec2 along = listsAlong(cell);
  uint number = countBefore(gl_LocalInvocationIndex, countOfListed(cell));
  number += groupOffsets[gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x];
  SampleList list = SampleList(push.list);
  const int first = placeOfCoarse(cell);
  if (along.x) list.samples[number++] = uint(first + 1);
  if (along.y) list.samples[number++] = uint(first + frame.samples.x);
  if (all(along)) list.samples[number] = uint(first + frame.samples.x + 1);
}
