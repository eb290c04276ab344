#version 460
// A thread per sample of the image's lattice marches its ray through the slices of blocks across the index axis that it
// passes most slices of, and adds up what four blocks of each slice send to the eye, interpolated bilinearly, behind
// what the ray has passed before: Subr et al. 2007, Section 2.1, Eq. 3 and 4, with the transmittance of the ray itself
// in place of the attenuation table.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_interface.h"
#include "packed_light.glsl"

layout(constant_id = 0) const int kAxis = 2;        // rays with another axis are left to other dispatches
layout(constant_id = 1) const bool kTowards = false;  // whether the light of blocks depends on the direction to the eye
layout(constant_id = 2) const bool kColored = true;   // whether blocks have source terms of their own

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;
layout(scalar, binding = 0) uniform Frame { GatherFrame frame; };
#include "gather_ray.glsl"
layout(binding = 1) uniform utextureBuffer brickNumbers;
// Quads: of two neighbours along the first side each, of this position and of the next one along the second side.
layout(binding = 2) uniform utextureBuffer extinctionQuads;  // four halves
layout(binding = 3) uniform utextureBuffer sourceQuads;      // four packed source terms, where kColored says so
layout(binding = 4) uniform utextureBuffer towardsQuads;     // four times three bytes, where kTowards says so
layout(binding = 5, rgba32f) writeonly uniform imageBuffer colorEnergy;  // C, E
layout(binding = 6, r32f) writeonly uniform imageBuffer distances;       // sum of e times distance

const int kSideA = kAxis == 0 ? 1 : 0;
const int kSideB = kAxis == 2 ? 1 : 2;

struct Ray {
  vec2 origin, slope;   // positions on the sides: origin + slope * slice, in blocks of the level
  float direction;      // 1 or -1, of ascending or descending slices
  int group;            // slices that are tested for emptiness together: no more than a brick's edge on any axis
  float eye;            // where the ray starts, slices of the level
  float layer;          // world length of a slice of the level on the ray, times the extinction's unit
  vec3 toEye;           // in the world, of length 1
};

// The level's geometry, read once a level.
struct Slices {
  ivec2 dimensions;     // of the sides, blocks
  int firstCell;
  ivec3 cellStrides;    // of the sides and the axis
  ivec2 lastCell;       // of the sides
};

struct Sums {
  vec3 color;
  float distance;       // sum of e times slices from the eye
  float transmittance;
};

// Weights of the two neighbours of a quad along a side; `low` becomes the quad that has them.
vec2 sideWeights(float position, int count, out int low) {
  const float first = floor(position);
  const float part = position - first;
  low = int(first);
  const vec2 weights = low < 0 ? vec2(low == -1 ? part : 0.0, 0.0) : vec2(low < count ? 1.0 - part : 0.0, part);
  low = clamp(low, 0, count - 1);
  return weights;
}

// Source term and extinction, interpolated.
vec4 sliceAt(Slices level, vec2 position, int slice, vec3 toEye) {
  ivec2 low;
  const vec2 a = sideWeights(position.x, level.dimensions.x, low.x);
  const vec2 b = sideWeights(position.y, level.dimensions.y, low.y);
  const vec4 weights = vec4(a * b.x, a * b.y);
  const ivec3 place = ivec3(low, slice);
  const ivec3 cell = place >> kSkipLevels;
  const int cellNumber = level.firstCell + cell.x * level.cellStrides.x + cell.y * level.cellStrides.y +
                         cell.z * level.cellStrides.z;
  const int brick = int(texelFetch(brickNumbers, cellNumber).x);
  const ivec3 inBrick = place & (kGatherGroup - 1);
  const int quad = ((brick << kSkipLevels | inBrick.y) << kSkipLevels | inBrick.x) << kSkipLevels | inBrick.z;
  const uvec2 halves = texelFetch(extinctionQuads, quad).xy;
  const vec4 extinctions = vec4(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y));
  const float extinction = dot(weights, extinctions);
  if (!kColored) return vec4(extinction * frame.color, extinction);
  const uvec4 packed = texelFetch(sourceQuads, quad);
  vec4 shares = weights;
  if (kTowards) {
    const uvec4 towards = texelFetch(towardsQuads, quad);
    [[unroll]] for (int i = 0; i < 4; ++i) shares[i] *= 1.0 + dot(unpackSnorm4x8(towards[i]).xyz, toEye);
  }
  vec3 source = vec3(0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) source += shares[i] * unpackLight(packed[i]);
  return vec4(source, extinction);
}

// The part of a slice's tent that is in front of the eye, which is `ahead` slices before it.
float partInFront(float ahead) {
  const float a = clamp(ahead, -1.0, 1.0);
  return a >= 0.0 ? 0.5 + a - 0.5 * a * a : 0.5 * (1.0 + a) * (1.0 + a);
}

// The slice's light is constant over it; what leaves it is the mean of its own transmittance.
void addSlice(inout Sums sums, Slices level, Ray ray, int slice) {
  const vec4 found = sliceAt(level, ray.origin + ray.slope * float(slice), slice, ray.toEye);
  const float ahead = (float(slice) - ray.eye) * ray.direction;
  const float length = ray.layer * partInFront(ahead);
  const float depth = length * found.a;
  const float through = exp(-depth);
  const float leaving = depth < 0.01 ? 1.0 - 0.5 * depth : (1.0 - through) / depth;
  const float rest = sums.transmittance * through;
  sums.color += sums.transmittance * leaving * length * found.rgb;
  sums.distance += (sums.transmittance - rest) * max(ahead, 0.0);
  sums.transmittance = rest;
}

// Whether the ray.group slices from `slice` on in the ray's direction may hold anything.
bool mayHold(Slices level, Ray ray, int slice) {
  const float last = float(slice) + ray.direction * float(ray.group - 1);
  const vec2 low = min(ray.origin + ray.slope * float(slice), ray.origin + ray.slope * last);
  const ivec2 cell = clamp(ivec2(floor(low)) >> kSkipLevels, ivec2(0), level.lastCell);
  const int plane = max(min(slice, int(last)), 0) >> kSkipLevels;
  return texelFetch(brickNumbers, level.firstCell + cell.x * level.cellStrides.x + cell.y * level.cellStrides.y +
                                      plane * level.cellStrides.z).x != 0;
}

// The slices from `slices.x` to `slices.y` - 1 that the ray meets within the volume and in front of the eye.
ivec2 slicesOnRay(Slices level, Ray ray, ivec2 slices) {
  vec2 range = vec2(slices) - vec2(0.0, 1.0);
  [[unroll]] for (int side = 0; side < 2; ++side) {
    const float slope = abs(ray.slope[side]) < 1e-7 ? 1e-7 : ray.slope[side];
    const float a = (-1.0 - ray.origin[side]) / slope, b = (float(level.dimensions[side]) - ray.origin[side]) / slope;
    range = vec2(max(range.x, min(a, b)), min(range.y, max(a, b)));
  }
  if (ray.direction > 0.0)
    range.x = max(range.x, ray.eye - 1.0);
  else
    range.y = min(range.y, ray.eye + 1.0);
  // Beyond what 32 bits can count there is no slice.
  range = clamp(range, vec2(slices) - vec2(1.0), vec2(slices) + vec2(1.0));
  return ivec2(max(int(floor(range.x)), slices.x), min(int(ceil(range.y)), slices.y - 1));
}

void march(inout Sums sums, Slices level, Ray ray, ivec2 slices, float end) {
  const int direction = int(ray.direction);
  int slice = direction > 0 ? slices.x : slices.y;
  int left = slices.y - slices.x + 1;
  if (left <= 0) return;
  // Loops that end with their conditions: lavapipe runs a body once more, masked, where a loop begins with one.
  do {
    bool empty;
    do {
      empty = !mayHold(level, ray, slice);
      if (empty) {
        slice += direction * ray.group;
        left -= ray.group;
      }
    } while (empty && left > 0);
    if (left > 0) {
      const int rest = left - min(left, ray.group);
      do {
        addSlice(sums, level, ray, slice);
        slice += direction;
        --left;
      } while (left > rest);
    }
  } while (left > 0 && sums.transmittance > end);
}

Slices slicesOf(int number) {
  const GatherLevel level = frame.levels[number];
  Slices slices;
  slices.dimensions = ivec2(level.dimensions[kSideA], level.dimensions[kSideB]);
  slices.firstCell = level.firstCell;
  slices.cellStrides = ivec3(level.cellStrides[kSideA], level.cellStrides[kSideB], level.cellStrides[kAxis]);
  slices.lastCell = ivec2(level.lastCell[kSideA], level.lastCell[kSideB]);
  return slices;
}

void main() {
  const ivec2 index = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(index, frame.samples))) return;
  const vec3 position = samplePosition(frame.firstSample, frame.pitch, index);
  const vec3 components = alongAxes(position);
  if (marchAxis(position, components) != kAxis) return;

  const float along = components[kAxis];
  const vec3 world = frame.worldRay[0] * position.x + frame.worldRay[1] * position.y + frame.worldRay[2] * position.z;
  const vec2 slope = vec2(dot(frame.axes[kAxis].slope[0], position), dot(frame.axes[kAxis].slope[1], position)) / along;
  const vec2 middle = vec2(dot(frame.axes[kAxis].middle[0], position), dot(frame.axes[kAxis].middle[1], position)) / along;
  const float middlePlane = frame.axes[kAxis].middlePlane;
  const float eye = dot(frame.axes[kAxis].eye, position);
  Sums sums = Sums(vec3(0.0), 0.0, 1.0);
  float distance = 0.0;  // sum of e times world distance from the eye plane
  for (int number = frame.finest; number <= frame.coarsest; ++number) {
    // In blocks of the level, whose first one's middle is at half an edge less half a voxel.
    const float edge = float(1 << number);
    const Slices level = slicesOf(number);
    Ray ray;
    ray.origin = (middle + slope * (0.5 * edge - 0.5 - middlePlane) + 0.5) / edge - 0.5;
    ray.slope = slope;
    ray.direction = along > 0.0 ? 1.0 : -1.0;
    ray.group = max(abs(slope.x), abs(slope.y)) > 1.0 ? kObliqueGroup : kGatherGroup;
    ray.eye = (eye + 0.5) / edge - 0.5;
    ray.layer = length(world) / abs(along) * edge * frame.extinctionUnit;
    ray.toEye = -normalize(world);
    const ivec2 slices = slicesOnRay(level, ray, frame.axes[kAxis].slices[along > 0.0 ? 1 : 0][number]);
    sums.distance = 0.0;
    if (sums.transmittance > frame.end) march(sums, level, ray, slices, frame.end);
    distance += sums.distance * edge / abs(along);
  }
  // A ray that ended before the volume did: what is behind counts as what is in front of it.
  const float energy = 1.0 - sums.transmittance;
  const float whole = sums.transmittance > frame.end ? 1.0 : 1.0 / energy;
  const int place = index.x + index.y * frame.samples.x;
  imageStore(colorEnergy, place, whole * vec4(frame.sourceUnit * sums.color, energy));
  imageStore(distances, place, vec4(whole * distance));
}
