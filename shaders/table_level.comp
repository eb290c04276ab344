#version 460
// A level of the octree's attenuation table from the one below, all directions at once, a thread four blocks: Subr
// et al. 2007, Section 3.2, Eq. 7. The geometric mean of transmittances is the mean of optical depths. Children
// outside of the volume do not count, the others as much as they have voxels.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "interface.h"
#include "attenuation_code.glsl"
#include "blocks.glsl"

layout(constant_id = 0) const int kCode = kCodeDepth8;
layout(constant_id = 1) const int kFilter = kFilterGeometric;

layout(local_size_x = kLevelThreads) in;
layout(scalar, push_constant) uniform Push { TableLevelPush push; };
layout(scalar, binding = 0) readonly buffer PlaneAddresses { uvec2 planeAddresses[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CodePlane { uint words[]; };

// What the filter takes the mean of. A transmittance that is stored as 0 counts as half the smallest code: it is
// less than a whole one, and -infinity would be all that is left of any mean.
float filtered(uint byte) {
  const float depth = kCode == kCodeLinear8 && byte == 0 ? log(2.0 * 255.0) : decodeDepth(kCode, byte);
  return kFilter == kFilterGeometric ? depth : exp(-depth);
}
uint codeOf(float mean) { return encodeDepth(kCode, kFilter == kFilterGeometric ? mean : -log(mean)); }

void main() {
  const uvec2 plane = planeAddresses[gl_WorkGroupID.z];
  if (plane == uvec2(0)) return;  // no direction has this cell
  const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kLevelThreads;
  if (i >= push.wordCount) return;
  CodePlane codes = CodePlane(plane);
  const uint address = push.parent.first + 4 * i;
  const ivec3 cell = cellAt(push.parent, address);

  // Of the two columns and the four rows of children that each block has, in voxels.
  float columns[8];
  [[unroll]] for (int c = 0; c < 8; ++c)
    columns[c] = float(clamp(push.voxels.x - (2 * cell.x + c) * push.childEdge, 0, push.childEdge));
  vec4 sum = vec4(0.0), total = vec4(0.0);
  uvec4 largest = uvec4(0);
  [[unroll]] for (int row = 0; row < 4; ++row) {
    const ivec3 child = 2 * cell + ivec3(0, row & 1, row >> 1);
    const ivec3 inside = extentInside(child, push.childEdge, push.voxels);
    if (inside.y <= 0 || inside.z <= 0) continue;
    const float rowShare = float(inside.y) * float(inside.z);
    const uint word = blockAddress(push.child, child) / 4;
    [[unroll]] for (int w = 0; w < 2; ++w) {
      if (child.x + 4 * w >= push.child.dimensions.x) continue;
      const uint bytes = codes.words[word + w];
      [[unroll]] for (int c = 0; c < 4; ++c) {
        const int block = 2 * w + c / 2;
        const float share = rowShare * columns[4 * w + c];
        const uint byte = bitfieldExtract(bytes, 8 * c, 8);
        sum[block] += share * filtered(byte);
        total[block] += share;
        if (share > 0.0) largest[block] = max(largest[block], byte);
      }
    }
  }
  uint result = 0;
  [[unroll]] for (int block = 0; block < 4; ++block)  // what all children store as 0 is 0
    if (largest[block] > 0) result |= codeOf(sum[block] / total[block]) << (8 * block);
  codes.words[address / 4] = result;
}
