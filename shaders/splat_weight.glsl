// The footprint on the pixel's own ray, which is exact for perspective and for any voxel shape.
#ifndef SPLAT_WEIGHT_GLSL
#define SPLAT_WEIGHT_GLSL
#include "part_ahead.glsl"

layout(constant_id = 0) const bool kQuads = false;  // only quads can be cut

layout(scalar, push_constant) uniform Push { SplatPush push; };

layout(location = 0) flat in vec4 colorEnergy;
layout(location = 1) flat in vec4 conicDepth;
layout(location = 2) flat in vec3 centerDistance;
layout(location = 3) flat in vec3 depthToEye;

// |D|² at p from the middle of the image: linear . (1, x, y) + squares . (x², xy, y²).
float rayLength2At(vec2 p, vec3 linear, vec3 squares) {
  return linear.x + p.x * (linear.y + squares.x * p.x) + p.y * (linear.z + squares.y * p.x + squares.z * p.y);
}

// The pixel, from the middle of the image.
vec2 pixelPosition() { return gl_FragCoord.xy - push.imageMiddle; }

float rayLength2() {
  return rayLength2At(pixelPosition(), push.rayLength2, push.rayLength2Squares);
}

// World length of the pixel's ray per index length, from rayLength2().
float worldPerIndex(float length2) {
  return sqrt(rayLength2At(pixelPosition(), push.worldLength2, push.worldLength2Squares) / length2);
}

bool isCut() { return kQuads && conicDepth.w < 0.0; }

// Index length from the eye to the point of the ray nearest to the centre of a cut kernel.
float cutAhead(float length2) { return dot(conicDepth.xyz, vec3(1.0, pixelPosition())) * inversesqrt(length2); }

// f(r) without its peak, with r from the distance |q| between centre and eye; only the part in front of the
// eye.
float cutWeight(float length2) {
  const float ahead = cutAhead(length2);
  const float halfChord2 = kSplatRadius * kSplatRadius - depthToEye.z + ahead * ahead;
  if (halfChord2 <= 0.0) return 0.0;
  const float w = halfChord2 / (kSplatRadius * kSplatRadius);
  return (w * w) * (w * w) * partAhead(ahead * inversesqrt(halfChord2));
}

// f(r) without its peak.
float splatWeight(float length2) {
  if (isCut()) return cutWeight(length2);
  const vec2 d = pixelPosition() - centerDistance.xy;
  const vec3 conic = conicDepth.xyz;
  const float r2 = (d.x * (conic.x * d.x + 2.0 * conic.y * d.y) + conic.z * d.y * d.y) / length2;
  const float w = max(1.0 - r2, 0.0);
  return (w * w) * (w * w);
}

#endif
