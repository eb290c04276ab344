#version 460
// A visible voxel becomes a splat: its transmittance to the eye, colour, and footprint on the image (Subr et
// al. 2007, Section 3.3 and 4.1, Eq. 10). Independent of every other voxel.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "attenuation_code.glsl"
#define TRANSFER_BINDING 1
#include "transfer_function.glsl"

layout(local_size_x = kSplatThreads) in;
layout(scalar, push_constant) uniform Push { SetupPush push; };
layout(scalar, binding = 0) readonly buffer Frame { SetupFrame frame; };
layout(scalar, binding = 2) readonly buffer PlaneAddresses { uvec2 planeAddresses[]; };
layout(scalar, binding = 3) readonly buffer VisibleVoxels { uint visibleVoxels[]; };
layout(scalar, binding = 4) readonly buffer Scalars { float scalars[]; };
layout(scalar, binding = 5) readonly buffer Extinction { float extinction[]; };
layout(scalar, binding = 6) readonly buffer Chunks { ChunkArguments chunks[]; };
layout(scalar, binding = 7) writeonly buffer Splats { Splat splats[]; };
#define PLANE_ADDRESS(cell) planeAddresses[cell]
#include "direction_lookup.glsl"

// (1 - exp(-x)) / x, also right for small x.
float selfAttenuation(float x) {
  return x < 0.02 ? 1.0 - x * (1.0 / 2.0 - x * (1.0 / 6.0 - x * (1.0 / 24.0))) : (1.0 - exp(-x)) / x;
}

vec3 colorOf(uint voxel) {
  if (frame.opacityPoints == 0) return frame.albedo;
  return evaluatePoints(frame.opacityPoints, frame.colorPoints, scalars[voxel]);
}

vec3 positionOf(uint voxel) {
  const uint row = voxel / frame.rowPitch;
  const uint plane = row / frame.rows;
  return vec3(voxel - row * frame.rowPitch, row - plane * frame.rows, plane);
}

struct Footprint {
  vec2 center, halfExtent;
  vec3 conic;
  float amplitude;  // 1, less where the footprint is widened
  float distance;
};

// A footprint narrower than the pixel lattice can sample is widened to it, with its integral kept: `shape`
// holds the squared semi-axes (xx, xy, yy) in pixels, `scale` is |D|² at the centre.
void widenToPixel(inout Footprint footprint, vec3 shape, float scale) {
  const float before = shape.x * shape.z - shape.y * shape.y;
  const float largest = 0.5 * (shape.x + shape.z) + length(vec2(0.5 * (shape.x - shape.z), shape.y));
  const float missing = kSplatRadius * kSplatRadius - before / largest;
  if (missing <= 0.0) return;
  const vec3 widened = shape + vec3(missing, 0.0, missing);
  const float after = widened.x * widened.z - widened.y * widened.y;
  footprint.conic = vec3(widened.z, -widened.y, widened.x) * (scale / after);
  footprint.amplitude = sqrt(max(before, 0.0) / after);
  footprint.halfExtent *= sqrt(widened.xz / shape.xz);
}

// The kernel's sphere of radius R around the index position `offset` (from the volume's middle) seen from the
// eye: all rays D with |q x D|² <= R² |D|². Returns false behind the eye, and in perspective also where it
// reaches the eye plane.
bool project(vec3 offset, out Footprint footprint) {
  const vec3 q = offset + frame.eyeToMiddle;
  const vec3 pixel = frame.indexToPixel * offset + frame.middleInPixels;
  const float radius2 = kSplatRadius * kSplatRadius;
  const vec3 ray = frame.orthographic != 0 ? frame.ray : q / pixel.z;
  const vec3 u = frame.orthographic != 0 ? cross(frame.pixelX, ray) : cross(q, frame.pixelX);
  const vec3 v = frame.orthographic != 0 ? cross(frame.pixelY, ray) : cross(q, frame.pixelY);
  const vec3 quadric = vec3(dot(u, u), dot(u, v), dot(v, v));
  const float scale = dot(ray, ray);
  const vec3 shape =
      vec3(quadric.z, -quadric.y, quadric.x) * (radius2 * scale / (quadric.x * quadric.z - quadric.y * quadric.y));
  footprint.conic = quadric / radius2;
  footprint.amplitude = 1.0;
  footprint.distance = pixel.z;
  if (pixel.z <= 0.0) return false;

  if (frame.orthographic != 0) {
    footprint.center = pixel.xy;
    footprint.halfExtent = sqrt(shape.xz);
  } else {
    // The bounds of the projected sphere, from its dual conic R² K Kᵀ - k kᵀ in pixels around the centre.
    const mat3 rows = transpose(frame.indexToPixel);
    const float nearest = pixel.z * pixel.z - radius2 * dot(rows[2], rows[2]);
    if (nearest <= 0.0) return false;
    footprint.center = pixel.xy / pixel.z;
    const vec3 rowX = rows[0] - footprint.center.x * rows[2];
    const vec3 rowY = rows[1] - footprint.center.y * rows[2];
    const vec2 shift = radius2 * vec2(dot(rowX, rows[2]), dot(rowY, rows[2]));
    const vec2 reach = sqrt(shift * shift + radius2 * vec2(dot(rowX, rowX), dot(rowY, rowY)) * nearest);
    footprint.halfExtent = (abs(shift) + reach) / nearest;
  }
  widenToPixel(footprint, shape, scale);
  return true;
}

void main() {
  const uint local = gl_GlobalInvocationID.x;
  if (local >= chunks[push.chunk].splatCount) return;
  const uint voxel = visibleVoxels[push.chunk * kSplatsPerChunk + local];
  const vec3 offset = positionOf(voxel) - frame.middle;

  Splat splat;
  Footprint footprint;
  if (!project(offset, footprint)) {
    splat.halfExtent = vec2(0.0);
    splats[local] = splat;
    return;
  }
  const vec3 toEye = frame.orthographic != 0 ? -frame.ray : -(offset + frame.eyeToMiddle);
  const vec3 size = abs(toEye);
  const vec3 direction = toEye / max(size.x, max(size.y, size.z));
  const float layer = length(frame.indexToWorld * direction);  // world length of one lattice layer
  const float transmittance = transmittanceTowards(frame.code, frame.lookup, frame.cells, direction, voxel);

  const float sigma = extinction[voxel];
  const float peak = kSplatPeak * footprint.amplitude;
  const float energy = transmittance * sigma * selfAttenuation(sigma * layer) * peak;
  splat.colorEnergy = vec4(energy * colorOf(voxel), energy);
  splat.center = footprint.center;
  splat.halfExtent = footprint.halfExtent;
  splat.conic = footprint.conic;
  splat.opticalDepth = sigma * peak;
  splat.distance = footprint.distance;
  splats[local] = splat;
}
