// The transfer function: piecewise linear, constant beyond its ends. One buffer holds the opacity points
// (scalar, opacity, 0, 0), then the colour points (scalar, r, g, b). Include after defining TRANSFER_BINDING.
layout(scalar, binding = TRANSFER_BINDING) readonly buffer TransferPoints { vec4 transferPoints[]; };

vec3 evaluatePoints(uint first, uint count, float scalar) {
  uint low = 0, high = count;  // the segment is [low, low + 1) once they are neighbours
  while (high - low > 1) {
    const uint middle = (low + high) / 2;
    if (transferPoints[first + middle].x <= scalar)
      low = middle;
    else
      high = middle;
  }
  const vec4 a = transferPoints[first + low];
  const vec4 b = transferPoints[first + min(low + 1, count - 1)];
  const float weight = b.x > a.x ? clamp((scalar - a.x) / (b.x - a.x), 0.0, 1.0) : 0.0;
  return mix(a.yzw, b.yzw, weight);
}
