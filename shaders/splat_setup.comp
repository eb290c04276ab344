#version 460
// A voxel or a block of them becomes a splat: its transmittance to the eye, colour, and footprint on the image
// (Subr et al. 2007, Section 3.3 and 4.1, Eq. 10). Independent of every other one.
#extension GL_GOOGLE_include_directive : require
#include "block_color.glsl"
#include "depth_to_eye.glsl"
#include "lighting.glsl"
#include "splat_projection.glsl"

layout(local_size_x = kSplatThreads) in;
layout(scalar, push_constant) uniform Push { SetupPush push; };
layout(scalar, binding = 4) readonly buffer BlockList { uint visibleVoxels[]; };
layout(scalar, binding = 5) readonly buffer Chunks { ChunkArguments chunks[]; };
layout(scalar, binding = 6) writeonly buffer Splats { Splat splats[]; };

void main() {
  const uint local = gl_GlobalInvocationID.x;
  if (local >= chunks[push.chunk].splatCount) return;
  const uint address = visibleVoxels[chunks[push.chunk].firstSplat + local];
  const Block block = blockAt(address);

  Splat splat;
  Footprint footprint;
  if (!project(centerOfMass(block) - frame.middle, float(block.edge), footprint)) {
    splat.halfExtent = vec2(0.0);
    splats[local] = splat;
    return;
  }
  const uint rank = rankAt(frame.levels[block.level], address);
  const float sigma = storedExtinction(rank);
  const DepthToEye toEye = depthToEye(block, sigma);
  const vec3 direction = directionToEye(block.center);
  const float depth = sigma * layerLength(direction) * float(layersOf(block, direction));
  // The kernel of a block is as much wider as its edge is longer, and integrates to the voxels it has.
  const vec3 part = vec3(block.extent) / float(block.edge);
  const float peak = kSplatPeak * footprint.amplitude * footprint.ahead * float(block.edge) * (part.x * part.y * part.z);
  const bool ofKernel = frame.kernelMean != 0 && block.level == 0;
  const float leaving = ofKernel ? kernelMean(block.center, direction, depth, toEye.depth) : selfAttenuation(depth);
  const float energy = sigma * leaving * peak;
  vec3 color = colorOf(block, rank), deltaFactor = vec3(1.0);
  if (kLit && kTinted && frame.lighting.forward > 0.0) {  // what is scattered forwards goes on, to the eye as well
    [[unroll]] for (int c = 0; c < 3; ++c) {
      const float deltaScale = 1.0 - frame.lighting.forward * color[c];
      deltaFactor[c] = selfAttenuation(deltaScale * depth) / selfAttenuation(depth) * exp((1.0 - frame.lighting.deltaScale[c]) * toEye.depth);
    }
  }
  if (kLit) color *= deltaFactor * scatteredLight(block, sigma, rank, normalize(frame.indexToWorld * direction), depth).light;
  splat.colorEnergy = vec4(energy * color, energy);
  if (kEmits) splat.colorEnergy.rgb += deltaFactor * leaving * peak * frame.emissionUnit * unpackLight(storedEmission(rank));
  splat.center = footprint.center;
  splat.halfExtent = footprint.halfExtent;
  splat.conic = footprint.conic;
  splat.opticalDepth = sigma * peak;
  splat.distance = footprint.distance;
  // Per pixel. In a pixel that a footprint had to be widened to, the depth changes from voxel to voxel, and the
  // voxel's own gradient soon says nothing: it fades with the widening; a block's with that of its children.
  const float kept = footprint.amplitude * (block.level == 0 ? 1.0 : min(0.25 * footprint.edge2, 1.0));
  const float fade = (kept * kept) * (kept * kept);
  const float perPixel = fade * (frame.orthographic != 0 ? 1.0 : footprint.distance);
  splat.depthToEye =
      vec3(toEye.depth, perPixel * vec2(dot(toEye.gradient, frame.pixelX), dot(toEye.gradient, frame.pixelY)));
  if (footprint.cut) {
    const vec3 fromEye = block.center - frame.middle + frame.eyeToMiddle;
    // What has light alone is cut, too.
    splat.opticalDepth = kEmits ? -max(splat.opticalDepth, kMinExtinction) : -splat.opticalDepth;
    splat.depthToEye = vec3(toEye.depth, 0.0, dot(fromEye, fromEye));
    if (frame.gradient != 0) splat.depthToEye.xy += sigma * vec2(-length(frame.indexToWorld * fromEye), 1.0);
  }
  splats[local] = splat;
}
