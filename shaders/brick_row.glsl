// A row of a brick of scalars, a thread a row, and their extinction. Physical: density x scale; or a transfer function
// whose opacity is per unit distance. The CPU's classify() (engine/volume/classification.h) says the same in double
// precision. And the light that they send out, packed_light.glsl. Include after interface.h and blocks.glsl; takes the
// bindings 0 to 3.

layout(constant_id = 0) const bool kEmits = false;

layout(local_size_x = kBrickThreads) in;
layout(scalar, push_constant) uniform Push { BricksPush push; };
layout(scalar, binding = 0) readonly buffer Scalars { vec4 scalars[]; };
layout(scalar, binding = 1) readonly buffer FirstVoxels { ivec3 firstVoxels[]; };  // of the bricks
layout(scalar, binding = 3) readonly buffer Emissions { uint emissions[]; };       // as the scalars
#define TRANSFER_BINDING 2
#include "transfer_function.glsl"

// -log(1 - x), also right for small x, where 1 - x has few digits left.
float opticalDepthOf(float opacity) {
  const float series = opacity * (1.0 + opacity * (1.0 / 2.0 + opacity * (1.0 / 3.0 + opacity * (1.0 / 4.0))));
  return opacity < 0.02 ? series : -log(1.0 - opacity);
}

float extinctionOf(float scalar) {
  if (scalar == kInactiveScalar) return 0.0;
  const float extinction =
      push.opacityPoints == 0
          ? max(scalar, 0.0) * push.densityScale
          : opticalDepthOf(min(evaluatePoints(0, push.opacityPoints, scalar).x, kMaximumOpacity)) / push.unitDistance;
  return min(extinction, kMaximumExtinction);
}

struct Row {
  float scalars[kBrickEdge];
  float extinction[kBrickEdge];
  uint emission[kBrickEdge];
  uint holding;  // a bit for each voxel with extinction or light; none for what is beyond the box
  ivec3 first;   // voxel
};

uint brickOfThread() { return gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x; }

Row loadRow(uint brick) {
  const int thread = int(gl_LocalInvocationIndex);
  Row row;
  row.first = firstVoxels[brick] + ivec3(0, thread % kBrickEdge, thread / kBrickEdge);
  row.holding = 0;
  [[unroll]] for (int q = 0; q < kBrickEdge / 4; ++q) {
    const vec4 quad = scalars[(brick * kBrickThreads + thread) * (kBrickEdge / 4) + q];
    [[unroll]] for (int c = 0; c < 4; ++c) {
      const int i = 4 * q + c;
      row.scalars[i] = quad[c];
      row.extinction[i] = extinctionOf(quad[c]);
      row.emission[i] = kEmits ? emissions[(brick * kBrickThreads + thread) * kBrickEdge + i] : 0;
      row.holding |= uint(row.extinction[i] > 0.0 || row.emission[i] != 0) << i;
    }
  }
  return row;
}
