#version 460
// A thread for each sample of the image's lattice marches its ray through the slices of blocks across the
// index axis of which it passes most slices. It adds the light that four blocks of each slice send to the
// eye, interpolated bilinearly and dimmed by what the ray has passed before: Subr et al. 2007, Section 2.1,
// Eq. 3 and 4, with the transmittance of the ray itself instead of the attenuation table.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define TRANSFER_TABLE_BINDING 7
#include "gather_ray.glsl"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "packed_light.glsl"
#include "packed_gradient.glsl"

// Compiled for each combination of these, because drivers take long to specialise code of this size:
const bool kScalars = SCALARS;    // whether voxels are classified after interpolation
const bool kSampled = SAMPLED;    // whether light is evaluated at samples
const bool kSurfaces = SURFACES;  // whether they then may be surfaces
const bool kParts = PARTS;        // whether only the bricks of a part are marched (GatherPart)
const bool kRegion = REGION;      // whether only a cube of the volume is marched, behind those that were marched before (GatherRegion)

layout(constant_id = 0) const int kAxis = 2;          // rays with another axis are marched by other dispatches
layout(constant_id = 1) const bool kTowards = false;  // whether the light of blocks depends on the direction to the eye
layout(constant_id = 2) const bool kColored = true;   // whether blocks have their own source terms
layout(constant_id = 3) const bool kLit = false;      // whether scalars have light of voxels
layout(constant_id = 4) const bool kPieces = false;   // whether quads are in more than one piece
layout(constant_id = 5) const int kLights = 0;        // number of lights evaluated at samples
layout(constant_id = 6) const int kAmbient = 0;       // channels of ambient light evaluated at samples
layout(constant_id = 7) const int kOctaves = 1;       // orders of scattering
layout(constant_id = 8) const bool kTinted = false;   // whether the extinction differs between the colours of light

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;
layout(binding = 1) uniform utextureBuffer brickNumbers;     // with kParts, bricks of the part have kOwnBrick
// Each quad has two neighbours along the first side, at this position and at the next one along the second
// side.
layout(binding = 2) uniform utextureBuffer mediumQuads;      // extinctions, four halves; or four codes of scalars
layout(binding = 3) uniform utextureBuffer sourceQuads;      // four packed source terms; only with kColored
layout(binding = 4) uniform utextureBuffer towardsQuads;     // four times three bytes; only with kTowards
layout(binding = 5, rgba32f) SUMS_ACCESS uniform imageBuffer colorEnergy;  // C, E
layout(binding = 6, r32f) SUMS_ACCESS uniform imageBuffer distances;       // sum of e times distance

// Codes of optical depths, 16 bits each: towards each light, then for each channel those that ambient light
// has passed.
layout(binding = 9) uniform utextureBuffer lightQuads0;
layout(binding = 10) uniform utextureBuffer lightQuads1;
layout(binding = 11) uniform utextureBuffer lightQuads2;
layout(binding = 12) uniform utextureBuffer lightQuads3;
layout(binding = 13) uniform utextureBuffer lightQuads4;
layout(binding = 14) uniform utextureBuffer lightQuads5;
layout(binding = 15) uniform utextureBuffer lightQuads6;
layout(buffer_reference, scalar, buffer_reference_align = 8) writeonly buffer PartSums { uvec2 values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Overflow { uint overflow; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer MediumPiece { uvec2 values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Gradients { uint values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer SourcePiece { uvec4 values[]; };
layout(binding = 8) uniform utextureBuffer skipCells;

const int kSideA = kAxis == 0 ? 1 : 0;
const int kSideB = kAxis == 2 ? 1 : 2;
const float kLeastShaded = 1.0 / 512.0;  // least part of a pixel for which the normal of a surface is computed
const float kMostlySurface = 0.95;        // surface share from which on other scattering is neglected
const float kOutside = 2.5;               // blocks
const float kMostLightDepth = 0.99 * kOpaqueDepth;  // approximately the end of the code of depths along rays

const int kPieceLog2 = kPieceBricksLog2 + 3 * kBrickLevels;  // quads
const int kPieceMask = (1 << kPieceLog2) - 1;

#include "gather_quads.glsl"

struct Ray {
  vec2 origin, slope;   // positions on the sides: origin + slope * slice, in blocks of the level
  float direction;      // 1 for ascending slices, -1 for descending ones
  int group;            // slices that are tested for emptiness together: at most a cell's edge on any axis
  float eye;            // start of the ray, in slices of the level
  float layer;          // world length of the ray in a slice of the level, times the unit of extinction
  vec3 toEye;           // unit vector in world space
  float edge;           // edge of a block in voxels
  float perSlice;       // distance from the eye plane that the ray moves in a slice of the level, world units
};

// The geometry of a level, read once for each level.
struct Slices {
  ivec2 dimensions;     // of the sides, in blocks
  int count;
  int firstCell;
  ivec3 cellStrides;    // of the sides and the axis
  int firstSkip;
  ivec3 skipStrides;    // of the sides and the axis
  ivec3 lastSkip;       // of the sides and the axis
  ivec3 first, begin, end;  // with kRegion: GatherRegion, of the sides and the axis
};

struct Sums {
  vec3 color;
  float distance;       // sum of e times slices from the eye
  float transmittance;
  // With kParts, the sums are those of one brick, and the optical depth is summed up too:
  float depth;
  float begin;          // transmittance in front of the brick
  int brick;            // 0 if none was entered
};

// With kParts: sums of the bricks so far, in fixed point (SumChannel), and whether they were in range.
uvec2 partSums[6];
bool partFits = true;
// The brick of the last quad if it belongs to the part, otherwise 0; with kRegion 1 if the quad is in the cube.
int ownBrick = 0;

// The weights of a quad's two neighbours along a side; sets `low` to the quad that has them.
vec2 sideWeights(float position, int count, out int low) {
  const float first = floor(position);
  const float part = position - first;
  low = int(first);
  const vec2 weights = low < 0 ? vec2(low == -1 ? part : 0.0, 0.0) : vec2(low < count ? 1.0 - part : 0.0, part);
  low = clamp(low, 0, count - 1);
  return weights;
}

// The brick at a position on the sides and the axis.
int brickAt(Slices level, ivec3 place) {
  if (kRegion) {
    ownBrick = all(greaterThanEqual(place, level.begin)) && all(lessThan(place, level.end)) ? 1 : 0;
    place -= level.first;
  }
  const ivec3 cell = place >> kBrickLevels;
  const uint brick = texelFetch(brickNumbers, level.firstCell + cell.x * level.cellStrides.x + cell.y * level.cellStrides.y +
                                                  cell.z * level.cellStrides.z).x;
  if (!kParts) return int(brick);
  const int number = int(brick & ~kOwnBrick);
  ownBrick = (brick & kOwnBrick) != 0 ? number : 0;
  return number;
}

// The quad of four blocks around a position on a slice, and their weights.
int quadAt(Slices level, vec2 position, int slice, out vec4 weights) {
  ivec2 low;
  const vec2 a = sideWeights(position.x, level.dimensions.x, low.x);
  const vec2 b = sideWeights(position.y, level.dimensions.y, low.y);
  weights = vec4(a * b.x, a * b.y);
  const ivec3 place = ivec3(low, slice);
  const int brick = brickAt(level, place);
  const ivec3 inBrick = place & (kGatherBrickEdge - 1);
  return ((brick << kBrickLevels | inBrick.y) << kBrickLevels | inBrick.x) << kBrickLevels | inBrick.z;
}

// The sum of a quad's source terms.
vec3 sourceAt(int quad, uvec4 packed, vec4 weights, vec3 toEye) {
  if (kTowards) {
    const uvec4 towards = towardsQuad(quad);
    [[unroll]] for (int i = 0; i < 4; ++i) weights[i] *= 1.0 + dot(unpackSnorm4x8(towards[i]).xyz, toEye);
  }
  vec3 source = vec3(0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) source += weights[i] * unpackLight(packed[i]);
  return source;
}

// The part of a slice's tent that is in front of the eye, if the slice is `ahead` slices in front of it.
float partInFront(float ahead) {
  const float a = clamp(ahead, -1.0, 1.0);
  return a >= 0.0 ? 0.5 + a - 0.5 * a * a : 0.5 * (1.0 + a) * (1.0 + a);
}

#include "gather_light.glsl"

// Adds a part of the ray of this length with a constant source term (rgb) and extinction (a), `ahead` slices
// from the eye. The light that leaves it is dimmed by the mean of its own transmittance.
void addPart(inout Sums sums, vec4 medium, float length, float ahead, Lit lit, vec3 toEye) {
  const float depth = length * medium.a;
  const float through = exp(-depth);
  const float rest = sums.transmittance * through;
  vec3 leaving = vec3(depth < 0.01 ? 1.0 - 0.5 * depth : (1.0 - through) / depth);
  if (kSampled) {
    leaving = vec3(0.0);
    [[unroll]] for (int c = 0; c < 3; ++c)
      if (c < kAmbient) leaving[c] = exp(-lit.ambientBegin[c]) * meanTransmittance(depth + lit.ambientChange[c]);
    leaving = frame.ambient * (kAmbient == 1 ? leaving.rrr : leaving);
    [[unroll]] for (int i = 0; i < kMostSampleLights; ++i)
      if (i < kLights) leaving += lightOf(i, lit, depth, toEye);
  }
  sums.color += sums.transmittance * length * leaving * medium.rgb;
  sums.distance += (sums.transmittance - rest) * max(ahead, 0.0);
  sums.transmittance = rest;
  if (kParts) sums.depth += depth;
}

float lightDepth(int slot, int quad, vec4 weights) {
  const uvec2 pairs = lightQuad(slot, quad);
  const float root = dot(weights, vec4(unpackUnorm2x16(pairs.x), unpackUnorm2x16(pairs.y)));
  return root * root * kOpaqueDepth;
}

vec4 depthsTowardsLights(int quad, vec4 weights) {
  vec4 depths = vec4(0.0);
  [[unroll]] for (int i = 0; i < kMostSampleLights; ++i)
    if (i < kLights) depths[i] = lightDepth(i, quad, weights);
  return depths;
}

vec3 ambientAt(int quad, vec4 weights) {
  vec3 depths = vec3(0.0);
  [[unroll]] for (int c = 0; c < 3; ++c)
    if (c < kAmbient) depths[c] = lightDepth(kLights + c, quad, weights);
  return depths;
}

// The values of a ray on a slice, for the stretch to the next slice.
struct Found {
  float coverage;  // by voxels with data, 0..1; if it is 0 the other values are undefined
  float scalar;    // in intervals of the transfer function's table
  float ahead;     // the scalar half a slice further on, continued in its plane
  float behind;    // the scalar half a slice before
  vec4 integral;   // integrals of extinction times colour (rgb) and of extinction (a) over the scalar
  vec4 medium;     // extinction times colour and extinction at the scalar
  vec3 light;      // relative to that of a source term of 1
  vec2 change;     // change of the scalar per voxel along the sides
  vec3 gradient;   // gradient of the scalar, or of the extinction, per block in index space
  bool hasGradient;
  vec4 depths;     // optical depths towards the lights, for scalars from a layer further on; negative if unknown
  vec4 arriving;   // for scalars, optical depths towards the lights; negative if not computed
  vec3 ambient;    // optical depths that ambient light has passed, by channel
};

vec3 voxelPosition(Ray ray, float slice) {
  const vec2 sides = ray.origin + ray.slope * slice;
  vec3 position;
  position[kAxis] = slice;
  position[kSideA] = sides.x;
  position[kSideB] = sides.y;
  return (position + 0.5) * ray.edge - 0.5;
}

#include "gather_parts.glsl"

vec4 extinctionsOf(int quad) {
  const uvec2 halves = mediumQuad(quad);
  return vec4(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y));
}

// The gradient at a position on a slice.
vec3 gradientAt(Slices level, vec2 position, int slice) {
  ivec2 low;
  const vec2 a = sideWeights(position.x, level.dimensions.x, low.x);
  const vec2 b = sideWeights(position.y, level.dimensions.y, low.y);
  const vec4 weights = vec4(a * b.x, a * b.y);
  vec3 gradient = vec3(0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    const ivec3 place = min(ivec3(low + ivec2(i & 1, i >> 1), slice), ivec3(level.dimensions, slice + 1) - 1);
    const int brick = brickAt(level, place);
    const ivec3 inBrick = place & (kGatherBrickEdge - 1);
    ivec3 block;
    block[kAxis] = inBrick.z;
    block[kSideA] = inBrick.x;
    block[kSideB] = inBrick.y;
    const int index = ((brick << kBrickLevels | block.z) << kBrickLevels | block.y) << kBrickLevels | block.x;
    gradient += weights[i] * unpackGradient(Gradients(frame.gradients).values[index]);
  }
  return gradient;
}

// The mean of both ends of a stretch.
void findGradients(inout Found last, inout Found found, Slices level, Ray ray, int slice) {
  for (int i = last.hasGradient ? 1 : 0; i < 2; ++i) {
    const int at = clamp(i == 1 ? slice : slice - int(ray.direction), 0, level.count - 1);
    const vec3 gradient = gradientAt(level, ray.origin + ray.slope * float(at), at);
    if (i == 1) found.gradient = gradient; else last.gradient = gradient;
  }
  last.hasGradient = found.hasGradient = true;
}

vec3 normalOf(vec3 gradient) {
  const vec3 normal = frame.gradientToWorld * gradient;
  return normal * inversesqrt(max(dot(normal, normal), 1e-30));
}

// `decrease` is the decrease of the extinction along a gradient, from one block before to one block behind,
// relative to the larger of the two.
void setSurface(inout Lit lit, vec3 gradient, float decrease) {
  const vec3 normal = frame.gradientToWorld * (sign(decrease) * gradient);
  lit.normal = normal * inversesqrt(max(dot(normal, normal), 1e-30));
  lit.surface = frame.surface * min(2.0 * abs(decrease), 1.0);
}

// Light reaches a surface from outside: shadows of its own voxels, which would be those of a staircase, are
// left to the normal.
struct Outside {
  vec4 depths;
  vec3 ambient;
};

Outside outsideOf(Slices level, Ray ray, float slice, vec3 outwards) {
  const vec3 way = kOutside * outwards * inversesqrt(max(dot(outwards, outwards), 1e-30));
  const vec2 position = ray.origin + ray.slope * slice + vec2(way[kSideA], way[kSideB]);
  vec4 weights;
  const int quad = quadAt(level, position, clamp(int(floor(slice + way[kAxis] + 0.5)), 0, level.count - 1), weights);
  return Outside(depthsTowardsLights(quad, weights), ambientAt(quad, weights));
}

void lightFrom(inout Lit lit, Outside outside) {
  lit.outside = outside.depths;
  lit.ambientBegin = mix(lit.ambientBegin, outside.ambient, lit.surface);
  lit.ambientChange *= 1.0 - lit.surface;
}

// The interpolated source term and extinction.
vec4 mediumAt(int quad, vec4 weights, vec4 extinctions, vec3 toEye) {
  const float extinction = dot(weights, extinctions);
  return vec4(kColored ? sourceAt(quad, sourceQuad(quad), weights, toEye) : extinction * frame.color, extinction);
}

// For classified blocks: source term and extinction are constant in a slice's layer.
void addSlice(inout Sums sums, Slices level, Ray ray, int slice) {
  vec4 weights;
  const int quad = quadAt(level, ray.origin + ray.slope * float(slice), slice, weights);
  const float ahead = (float(slice) - ray.eye) * ray.direction;
  const vec4 medium = mediumAt(quad, weights, extinctionsOf(quad), ray.toEye);
  if (kParts || kRegion) {
    if (ownBrick == 0 || medium == vec4(0.0)) return;
    if (kParts) enterBrick(sums, ray, ownBrick, float(slice) - 0.5 * ray.direction);
  }
  Lit lit;
  addPart(sums, medium, ray.layer * partInFront(ahead), ahead, lit, ray.toEye);
}

// For classified blocks that are lit at samples: the values on a slice.
Found litAt(Slices level, Ray ray, int slice, bool within) {
  vec4 weights;
  const int quad = quadAt(level, ray.origin + ray.slope * float(slice), slice, weights);
  Found found;
  found.medium = within ? mediumAt(quad, weights, extinctionsOf(quad), ray.toEye) : vec4(0.0);
  found.depths = depthsTowardsLights(quad, weights);
  found.ambient = ambientAt(quad, weights);
  found.coverage = found.medium.a > 0.0 ? 1.0 : 0.0;
  found.gradient = vec3(0.0);
  found.hasGradient = false;
  return found;
}

// For classified blocks that are lit at samples: the stretch from the previous slice. The depth towards a
// light changes along it as the depth towards the eye does, since both are integrals of the same extinction.
void addLitStretch(inout Sums sums, inout Found last, Slices level, Ray ray, int slice, bool within) {
  Found found = litAt(level, ray, within ? slice : slice - int(ray.direction), within);
  const int brick = ownBrick;
  const vec4 medium = 0.5 * (last.medium + found.medium);
  if (kParts || kRegion) {
    if (brick == 0 || medium == vec4(0.0)) {
      last = found;
      return;
    }
    if (kParts) enterBrick(sums, ray, brick, float(slice) - ray.direction);
  }
  const float ahead = (float(slice) - ray.eye) * ray.direction;
  Lit lit;
  lit.begin = last.depths.x < 0.0 ? max(found.depths - ray.layer * medium.a, vec4(0.0)) : last.depths;
  lit.change = found.depths - lit.begin;
  lit.ambientBegin = last.depths.x < 0.0 ? found.ambient : last.ambient;
  lit.ambientChange = found.ambient - lit.ambientBegin;
  lit.position = voxelPosition(ray, float(slice) - 0.5 * ray.direction);
  if (kSurfaces) {
    lit.surface = 0.0;
    if (sums.transmittance * ray.layer * medium.a > kLeastShaded) {
      findGradients(last, found, level, ray, slice);
      const vec3 gradient = 0.5 * (last.gradient + found.gradient);
      const float reach = length(gradient) / frame.extinctionUnit;
      setSurface(lit, gradient, -min(2.0 * reach / max(medium.a + reach, 1e-20), 1.0));
      lightFrom(lit, outsideOf(level, ray, float(slice) - 0.5 * ray.direction, -gradient));
    }
  }
  addPart(sums, medium, ray.layer * clamp(ahead, 0.0, 1.0), ahead - 0.5, lit, ray.toEye);
  last = found;
}

#include "gather_scalars.glsl"

// The number of groups of ray.group slices, starting at `slice` in the ray's direction, that are empty; 0 if
// the first, or the `before` slices in front of it, may not be.
int emptyGroups(Slices level, Ray ray, int slice, int before) {
  const float first = float(slice) - ray.direction * float(before), last = float(slice) + ray.direction * float(ray.group - 1);
  const vec2 low = min(ray.origin + ray.slope * first, ray.origin + ray.slope * last);
  ivec3 place = ivec3(floor(vec3(low, min(first, last))));
  if (kRegion) place -= level.first;
  const ivec3 cell = clamp(place >> kSkipLevels, ivec3(0), level.lastSkip);
  return int(texelFetch(skipCells, level.firstSkip + cell.x * level.skipStrides.x + cell.y * level.skipStrides.y +
                                       cell.z * level.skipStrides.z).x);
}

// The slices `slices.x` to `slices.y` - 1 that the ray meets inside the volume and in front of the eye.
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
  // There are no slices beyond what 32 bits can count.
  range = clamp(range, vec2(slices) - vec2(1.0), vec2(slices) + vec2(1.0));
  return ivec2(max(int(floor(range.x)), slices.x), min(int(ceil(range.y)), slices.y - 1));
}

// With kRegion: the slices, of which the first and the last may be too many, on which the ray is in the cube.
ivec2 slicesInRegion(Slices level, Ray ray) {
  vec2 range = vec2(level.begin.z, level.end.z - 1);
  [[unroll]] for (int side = 0; side < 2; ++side) {
    const float slope = abs(ray.slope[side]) < 1e-7 ? 1e-7 : ray.slope[side];
    // The first cube of the volume has the positions up to a voxel before it, too.
    const float a = (float(level.begin[side]) - 1.0 - ray.origin[side]) / slope, b = (float(level.end[side]) - ray.origin[side]) / slope;
    range = vec2(max(range.x, min(a, b)), min(range.y, max(a, b)));
  }
  range = clamp(range, vec2(level.begin.z - 2), vec2(level.end.z + 2));
  return ivec2(floor(range.x), ceil(range.y));
}

Found nothingFound() {
  Found nothing;
  nothing.coverage = nothing.scalar = nothing.ahead = nothing.behind = 0.0;
  nothing.integral = nothing.medium = vec4(0.0);
  nothing.light = nothing.gradient = nothing.ambient = vec3(0.0);
  nothing.change = vec2(0.0);
  nothing.hasGradient = false;
  nothing.depths = nothing.arriving = vec4(-1.0);
  return nothing;
}

// Branches on constants are nested, so that the compiler removes them.
void addBlocks(inout Sums sums, inout Found last, Slices level, Ray ray, int slice, bool within) {
  if (kSampled)
    addLitStretch(sums, last, level, ray, slice, within);
  else
    addSlice(sums, level, ray, slice);
}

void addAt(inout Sums sums, inout Found last, Slices level, Ray ray, int slice, bool within, bool scalars) {
  if (kScalars) {
    if (scalars)
      addStretch(sums, last, level, ray, slice, within);
    else
      addBlocks(sums, last, level, ray, slice, within);
  } else {
    addBlocks(sums, last, level, ray, slice, within);
  }
}

Found foundAt(Slices level, Ray ray, int slice, bool scalars) {
  if (kScalars) {
    if (scalars) return scalarAt(level, ray.origin + ray.slope * float(slice), slice, 0.5 * ray.direction * ray.slope, ray.toEye);
  }
  return litAt(level, ray, slice, true);
}

// For scalars one more slice is marched, which ends the last stretch.
void march(inout Sums sums, Slices level, Ray ray, ivec2 slices, float end, bool scalars) {
  const int direction = int(ray.direction);
  const int final = direction > 0 ? slices.y : slices.x;
  int slice = direction > 0 ? slices.x : slices.y;
  int left = slices.y - slices.x + 1;
  if (left <= 0) return;
  const int begin = slice;
  if (scalars || kSampled) ++left;
  Found last = nothingFound();
  if (kRegion) {
    const ivec2 own = slicesInRegion(level, ray);
    const int before = max(direction > 0 ? own.x - slice : slice - own.y, 0);
    slice += direction * before;
    // And the slice that ends the last stretch.
    left = min(left - before, (direction > 0 ? own.y - slice : slice - own.x) + 2);
    if (left <= 0) return;
    if ((scalars || kSampled) && slice != begin) last = foundAt(level, ray, slice - direction, scalars);
  }
  // The loops test their conditions at the end: lavapipe executes the body of other loops once more, masked.
  do {
    int empty;
    do {
      empty = emptyGroups(level, ray, slice, kParts || last.coverage > 0.0 ? 1 : 0) * ray.group;
      if (empty > 0) {
        last.coverage = 0.0;
        last.hasGradient = false;
        last.depths = last.arriving = vec4(-1.0);
        last.medium = vec4(0.0);
      }
      slice += direction * empty;
      left -= empty;
    } while (empty > 0 && left > 0);
    if (left > 0) {
      // What other bricks have in front of this one may have been skipped.
      if (kParts && (scalars || kSampled) && slice != begin) {
        const int before = slice - direction;
        last = foundAt(level, ray, before, scalars);
      }
      const int rest = left - min(left, ray.group);
      do {
        addAt(sums, last, level, ray, slice, slice != final + direction, scalars);
        slice += direction;
        --left;
      } while (left > rest);
    }
  } while (left > 0 && (kParts || sums.transmittance > end));
}

Slices slicesOf(int number) {
  const GatherLevel level = frame.levels[number];
  Slices slices;
  slices.dimensions = ivec2(level.dimensions[kSideA], level.dimensions[kSideB]);
  slices.count = level.dimensions[kAxis];
  slices.firstCell = level.firstCell;
  const ivec3 cellStrides = ivec3(1, level.cellStrides), skipStrides = ivec3(1, level.skipStrides);
  slices.cellStrides = ivec3(cellStrides[kSideA], cellStrides[kSideB], cellStrides[kAxis]);
  slices.firstSkip = level.firstSkip;
  slices.skipStrides = ivec3(skipStrides[kSideA], skipStrides[kSideB], skipStrides[kAxis]);
  slices.lastSkip = ivec3(level.lastSkip[kSideA], level.lastSkip[kSideB], level.lastSkip[kAxis]);
  if (kRegion) {
    const GatherRegion region = frame.region;
    slices.first = ivec3(region.first[kSideA], region.first[kSideB], region.first[kAxis]);
    slices.begin = ivec3(region.begin[kSideA], region.begin[kSideB], region.begin[kAxis]);
    slices.end = ivec3(region.end[kSideA], region.end[kSideB], region.end[kAxis]);
  }
  return slices;
}

void main() {
  ivec2 index = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(index, kParts ? frame.part.extent : kRegion ? frame.region.extent : frame.samples))) return;
  if (kParts) index += frame.part.first;
  if (kRegion) index += frame.region.corner;
  const vec3 position = samplePosition(frame.firstSample, frame.pitch, index);
  const vec3 components = alongAxes(position);
  if (marchAxis(position, components) != kAxis) return;

  const float along = components[kAxis];
  const vec3 world = frame.worldRay[0] * position.x + frame.worldRay[1] * position.y + frame.worldRay[2] * position.z;
  const vec2 slope = vec2(dot(frame.axes[kAxis].slope[0], position), dot(frame.axes[kAxis].slope[1], position)) / along;
  const vec2 middle = vec2(dot(frame.axes[kAxis].middle[0], position), dot(frame.axes[kAxis].middle[1], position)) / along;
  const float middlePlane = frame.axes[kAxis].middlePlane;
  const float eye = dot(frame.axes[kAxis].eye, position);
  Sums sums = Sums(vec3(0.0), 0.0, 1.0, 0.0, 1.0, 0);
  if (kParts)
    [[unroll]] for (int c = 0; c < 6; ++c) partSums[c] = uvec2(0);
  float distance = 0.0;  // sum of e times world distance from the eye plane
  const int place = index.x + index.y * frame.samples.x;
  vec3 colorBefore = vec3(0.0);
#ifdef CONTINUES_SUMS
  const vec4 before = imageLoad(colorEnergy, place);
  colorBefore = before.rgb;
  sums.transmittance -= before.a;
  distance = imageLoad(distances, place).x;
#endif
  for (int number = frame.finest; number <= frame.coarsest; ++number) {
    // In blocks of the level, the centre of whose first is at half an edge minus half a voxel.
    const float edge = float(1 << number);
    const Slices level = slicesOf(number);
    Ray ray;
    ray.origin = (middle + slope * (0.5 * edge - 0.5 - middlePlane) + 0.5) / edge - 0.5;
    ray.slope = slope;
    ray.direction = along > 0.0 ? 1.0 : -1.0;
    ray.group = max(abs(slope.x), abs(slope.y)) > 1.0 ? kObliqueGroup : kSkipGroup;
    ray.eye = (eye + 0.5) / edge - 0.5;
    ray.layer = length(world) / abs(along) * edge * frame.extinctionUnit;
    ray.toEye = -normalize(world);
    ray.edge = edge;
    ray.perSlice = edge / abs(along);
    const ivec2 slices = slicesOnRay(level, ray, frame.axes[kAxis].slices[along > 0.0 ? 1 : 0][number]);
    sums.distance = 0.0;
    if (kParts || sums.transmittance > frame.end) march(sums, level, ray, slices, frame.end, kScalars && number == 0);
    distance += ray.perSlice * sums.distance;
    if (kParts) endBrick(sums, ray);
  }
  if (kParts) {
    storePart(index - frame.part.first);
    return;
  }
  // For a ray that ended before the volume, what lies behind counts like what is in front.
  const float energy = 1.0 - sums.transmittance;
  const bool complete = !kRegion || frame.region.isLast != 0;
  const float whole = sums.transmittance > frame.end || !complete ? 1.0 : 1.0 / energy;
  imageStore(colorEnergy, place, whole * vec4(colorBefore + frame.sourceUnit * sums.color, energy));
  imageStore(distances, place, vec4(whole * distance));
}
