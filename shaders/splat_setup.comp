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
#include "major_axis.glsl"
#include "direction_lookup.glsl"
#include "ray_lookup.glsl"
#include "depth_to_eye.glsl"
#include "part_ahead.glsl"
#include "splat_projection.glsl"

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
  const uint plane = row / frame.dimensions.y;
  return vec3(voxel - row * frame.rowPitch, row - plane * frame.dimensions.y, plane);
}

void main() {
  const uint local = gl_GlobalInvocationID.x;
  if (local >= chunks[push.chunk].splatCount) return;
  const uint voxel = visibleVoxels[push.chunk * kSplatsPerChunk + local];
  const vec3 position = positionOf(voxel);

  Splat splat;
  Footprint footprint;
  if (!project(position - frame.middle, footprint)) {
    splat.halfExtent = vec2(0.0);
    splats[local] = splat;
    return;
  }
  const float sigma = extinction[voxel];
  const float layerDepth = sigma * layerLength(directionToEye(position));
  const float peak = kSplatPeak * footprint.amplitude * footprint.ahead;
  const float energy = sigma * selfAttenuation(layerDepth) * peak;
  splat.colorEnergy = vec4(energy * colorOf(voxel), energy);
  splat.center = footprint.center;
  splat.halfExtent = footprint.halfExtent;
  splat.conic = footprint.conic;
  splat.opticalDepth = sigma * peak;
  splat.distance = footprint.distance;
  const DepthToEye toEye = depthToEye(position, layerDepth);
  // Per pixel. In a pixel that a footprint had to be widened to, the depth changes from voxel to voxel, and the
  // voxel's own gradient soon says nothing: it fades with the widening.
  const float fade = footprint.amplitude * footprint.amplitude * footprint.amplitude * footprint.amplitude;
  const float perPixel = fade * (frame.orthographic != 0 ? 1.0 : footprint.distance);
  splat.depthToEye =
      vec3(toEye.depth, perPixel * vec2(dot(toEye.gradient, frame.pixelX), dot(toEye.gradient, frame.pixelY)));
  if (footprint.cut) {
    const vec3 fromEye = position - frame.middle + frame.eyeToMiddle;
    splat.opticalDepth = -splat.opticalDepth;
    splat.depthToEye = vec3(toEye.depth, 0.0, dot(fromEye, fromEye));
    if (frame.gradient != 0) splat.depthToEye.xy += sigma * vec2(-length(frame.indexToWorld * fromEye), 1.0);
  }
  splats[local] = splat;
}
