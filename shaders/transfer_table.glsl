// A transfer function's integrals over the scalar, in intervals (engine/volume/transfer_table.h), in binding
// TRANSFER_TABLE_BINDING.
#ifndef TRANSFER_TABLE_GLSL
#define TRANSFER_TABLE_GLSL
#include "gather_interface.h"
#ifndef TRANSFER_TABLE_BINDING
#error "Define TRANSFER_TABLE_BINDING, the binding of the texels, before including transfer_table.glsl."
#endif

layout(binding = TRANSFER_TABLE_BINDING) uniform textureBuffer transferTable;  // TransferTable::texels

// Least change of the scalar along a stretch, in intervals, for which its mean is taken from integrals.
const float kMinChange = 16.0;

// The transfer function's integral up to a scalar, and its value there.
void tableAt(float scalar, out vec4 integral, out vec4 medium) {
  const int interval = clamp(int(scalar), 0, kTransferIntervals - 1);
  medium = texelFetch(transferTable, 2 * interval + 1);
  integral = texelFetch(transferTable, 2 * interval) + (scalar - float(interval)) * medium;
}

// The mean of the transfer function between two scalars. Differences of nearly equal integrals have few
// significant digits.
vec4 meanBetween(float from, vec4 fromIntegral, vec4 fromMedium, float to, vec4 toIntegral, vec4 toMedium) {
  const float change = to - from;
  return abs(change) > kMinChange ? (toIntegral - fromIntegral) / change : 0.5 * (fromMedium + toMedium);
}

#endif
