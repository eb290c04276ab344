#version 460
// Writes the scalars of all voxels of a box, which may reach beyond the volume, as intervals of the transfer
// function's table; negative without data. A thread writes four voxels of a row.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "gather_interface.h"

layout(local_size_x = kExpandTile, local_size_y = kExpandTile) in;
layout(scalar, push_constant) uniform Push { ExpandScalarsPush push; };
layout(scalar, binding = 0) writeonly buffer BoxScalars { vec4 boxScalars[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Words { uint values[]; };

float scalarAt(ivec3 voxel) {
  if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, push.dimensions))) return -1.0;
  const ivec3 place = voxel + push.corner;
  const ivec3 cell = place / kBrickEdge, local = place % kBrickEdge;
  const uint brick = Words(push.bricks).values[cell.x + push.cells.x * (cell.y + push.cells.y * cell.z)];
  const uint index = ((brick * kBrickEdge + local.z) * kBrickEdge + local.y) * kBrickEdge + local.x;
  const uint code = bitfieldExtract(Words(push.codes).values[index / 2], int(index % 2) * 16, 16);
  return code == 0 ? -1.0 : (float(code) - 1.0) * (float(kTransferIntervals) / float(kScalarCodes));
}

void main() {
  const ivec3 place = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(place, push.extent))) return;
  const ivec3 voxel = push.first + ivec3(4 * place.x, place.yz);
  vec4 quad;
  [[unroll]] for (int i = 0; i < 4; ++i) quad[i] = scalarAt(voxel + ivec3(i, 0, 0));
  boxScalars[place.x + push.extent.x * (place.y + push.extent.y * place.z)] = quad;
}
