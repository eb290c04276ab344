#version 460
// Restores the round footprint of the lattice's sums: a slice's tent is as wide as a splat's kernel across
// the slice, but seen obliquely it is narrower along the tilt. A stencil of 3x3 samples adds the missing
// variance, at the mean distance of what the sample shows. It is not applied to interpolated scalars, which
// have no footprints. Of the lattice only listed tiles are stored.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_ray.glsl"
#include "lattice_tiles.glsl"
#include "mean_distance.glsl"
#include "opacity.glsl"

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;
layout(binding = 1) uniform textureBuffer colorEnergy;  // C, E
layout(binding = 2) uniform textureBuffer distances;    // sum of e times distance
layout(binding = 3, rgba32f) writeonly uniform imageBuffer colorEnergyOut;
layout(binding = 4, r32f) writeonly uniform imageBuffer distancesOut;
layout(scalar, binding = 5) readonly buffer List { uint tiles[]; };
layout(scalar, push_constant) uniform Push { TilesPush push; };

const int kGroupsOfATile = kLatticeTile / kGatherTile;  // along an edge

// The covariance (xx, xy, yy) that the sums lack, in squares of the lattice's pitch.
vec3 missingCovariance(vec3 position, float distance) {
  const int axis = marchAxis(position, alongAxes(position));
  const float scale = frame.orthographic != 0 ? 1.0 : 1.0 / distance;
  const vec2 tilt = (frame.axes[axis].tilt - position.yz * frame.axes[axis].tiltDepth) * scale;
  const vec3 covariance = kFootprintVariance * vec3(tilt.x * tilt.x, tilt.x * tilt.y, tilt.y * tilt.y);
  const vec3 inLattice = covariance / (frame.pitch * frame.pitch);
  return inLattice * min(kMaxVariance / max(inLattice.x + inLattice.z, 1e-20), 1.0);
}

void main() {
  const uint entry = tiles[push.firstOfRange + gl_WorkGroupID.y];
  const ivec2 group = ivec2(gl_WorkGroupID.x % kGroupsOfATile, gl_WorkGroupID.x / kGroupsOfATile);
  const ivec2 index = firstOfTile(int(entry >> kTileShift)) + group * kGatherTile + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(index, frame.firstSeen + frame.seenExtent))) return;
  vec4 colors[9];
  float weighted[9];
  [[unroll]] for (int i = 0; i < 9; ++i) {
    const int place = placeOfSample(index + ivec2(i % 3 - 1, i / 3 - 1));
    colors[i] = texelFetch(colorEnergy, place);
    weighted[i] = texelFetch(distances, place).x;
  }
  // The mean of all nine samples, as a sample beside a silhouette has no distance of its own.
  float energy = 0.0, distance = 0.0;
  [[unroll]] for (int i = 0; i < 9; ++i) {
    energy += colors[i].a;
    distance += weighted[i];
  }
  const vec3 position = samplePosition(frame.firstSample, frame.pitch, index);
  const vec3 covariance = energy > 1e-20 && distance > 0.0 ? missingCovariance(position, distance / energy) : vec3(0.0);
  const float cross = 0.25 * covariance.y;
  const float weights[9] = float[9](cross, 0.5 * covariance.z, -cross, 0.5 * covariance.x, 1.0 - covariance.x - covariance.z,
                                    0.5 * covariance.x, -cross, 0.5 * covariance.z, cross);
  // Footprints add up optical depths, so the stencil is applied to these; E, and with it the colour, follow.
  vec4 color = vec4(0.0);
  float depth = 0.0;
  MeanDistance mean = kNoDistance;
  [[unroll]] for (int i = 0; i < 9; ++i) {
    color += weights[i] * colors[i];
    depth += weights[i] * opticalDepthOf(min(colors[i].a, 1.0 - kMinTransmittance));
    addSample(mean, weights[i], colors[i].a, weighted[i]);
  }
  distance = distancesOf(mean, color.a);
  if (color.a > kMinTransmittance) {
    const float scale = opacityOf(max(depth, 0.0)) / color.a;
    color *= scale;
    distance *= scale;
  }
  const int place = placeOfSample(index);
  imageStore(colorEnergyOut, place, color);
  imageStore(distancesOut, place, vec4(distance));
}
