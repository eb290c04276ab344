#version 460
// Scalar -> extinction, four voxels an invocation. Physical: density x scale; or a transfer function whose
// opacity is per unit distance. The CPU's classify() (engine/volume/classification.h) says the same in double
// precision.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#define TRANSFER_BINDING 1
#include "transfer_function.glsl"

layout(local_size_x = kClassifyThreads) in;
layout(scalar, push_constant) uniform Push { ClassifyPush push; };
layout(scalar, binding = 0) readonly buffer Scalars { vec4 scalars[]; };
layout(scalar, binding = 2) writeonly buffer Extinction { vec4 extinction[]; };

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

void main() {
  const uint quad = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kClassifyThreads;
  if (quad >= push.quadCount) return;
  const vec4 scalar = scalars[quad];
  extinction[quad] = vec4(extinctionOf(scalar.x), extinctionOf(scalar.y), extinctionOf(scalar.z), extinctionOf(scalar.w));
}
