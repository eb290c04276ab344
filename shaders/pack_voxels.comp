#version 460
// The extinction and the scalars of the voxels that hold anything, each at its rank, a thread a voxel.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(constant_id = 0) const bool kScalars = false;  // are kept, for their colours

layout(local_size_x = kOccupancyThreads) in;
layout(scalar, push_constant) uniform Push { VoxelsPush push; };
layout(scalar, binding = 0) readonly buffer VisibleVoxels { uint visibleVoxels[]; };
layout(scalar, binding = 1) readonly buffer AllExtinction { float allExtinction[]; };
layout(scalar, binding = 2) readonly buffer AllScalars { float allScalars[]; };
layout(scalar, binding = 3) writeonly buffer Extinction { float extinction[]; };
layout(scalar, binding = 4) writeonly buffer Scalars { float scalars[]; };

void main() {
  const uint rank = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kOccupancyThreads;
  if (rank >= push.count) return;
  const uint voxel = visibleVoxels[rank];
  extinction[rank] = allExtinction[voxel];
  if (kScalars) scalars[rank] = allScalars[voxel];
}
