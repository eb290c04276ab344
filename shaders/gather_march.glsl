// What the parts of the gather's march share: the cases that it is compiled for, its buffers, a ray, the slices of blocks that it meets,
// and the look-up of the four blocks around a position on a slice.
#ifndef GATHER_MARCH_GLSL
#define GATHER_MARCH_GLSL
#include "gather_kept.glsl"
#include "gather_ray.glsl"

// Compiled for each combination of these, because drivers take long to specialise code of this size:
const bool kScalars = SCALARS;    // whether voxels are classified after interpolation
const bool kSampled = SAMPLED;    // whether light is evaluated at samples
const bool kSurfaces = SURFACES;  // whether they then may be surfaces
const bool kCube = CUBE;      // whether only a cube of the volume is marched, behind those that were marched before (GatherCube)
const bool kProjected = PROJECTED;  // whether scalars are projected, and not marched as a medium; then kScalars is set alone, or with kCube
const bool kMerged = MERGED;  // whether other volumes are on the way of the rays that are marched: what is met is added up in slabs

layout(constant_id = 0) const int kAxis = 2;          // rays with another axis are marched by other dispatches
layout(constant_id = 1) const bool kTowards = false;  // whether the light of blocks depends on the direction to the eye
layout(constant_id = 2) const bool kColored = true;   // whether blocks have their own source terms
layout(constant_id = 3) const bool kLit = false;      // whether scalars have light of voxels
layout(constant_id = 4) const bool kPieces = false;   // whether quads are in more than one piece
layout(constant_id = 5) const int kLights = 0;        // number of lights evaluated at samples
layout(constant_id = 6) const bool kScattered = false;  // whether samples have light that was scattered before or comes from everywhere
layout(constant_id = 7) const bool kFlux = false;     // whether that depends on the direction to the eye
layout(constant_id = 8) const bool kTinted = false;   // whether the extinction of light differs between colours, or from that of the eye
layout(constant_id = 9) const bool kEmits = false;    // whether blocks that are lit at samples emit light, too
layout(constant_id = 10) const bool kLevels = true;   // whether levels of blocks are marched behind scalars
layout(constant_id = 11) const bool kHoldout = false;  // whether rays end at the depths of a holdout
layout(constant_id = 14) const bool kClips = false;    // whether rays are marched in a part of the volume alone (GatherFrame::clips)
layout(constant_id = 15) const bool kQuarters = false;  // whether scalars are also classified at the quarters of a stretch

// Loops that lanes leave at different times have the form `do { if (goOn) ... } while (goOn)`, where `goOn` compares integers: lavapipe
// executes the body of any other loop once more with lanes masked, and computes values that are assigned outside of the `if` anew for lanes
// that have left. With a bool as the condition the compiler could drop the `if`.

layout(binding = 1) uniform utextureBuffer brickNumbers;
// Each quad has two neighbours along the first side, at this position and at the next one along the second
// side.
layout(binding = 2) uniform utextureBuffer mediumQuads;      // extinctions, four halves; or four codes of scalars
layout(binding = 3) uniform utextureBuffer sourceQuads;      // four packed source terms; only with kColored
// Four words: with kTowards three signed bytes each, how the source term depends on the direction to the eye; with kEmits packed
// emission.
layout(binding = 4) uniform utextureBuffer extraQuads;
layout(binding = 5, rgba32f) SUMS_ACCESS uniform imageBuffer colorEnergy;  // C, E
layout(binding = 6, r32f) SUMS_ACCESS uniform imageBuffer distances;       // sum of e times distance

layout(binding = 8) uniform utextureBuffer skipCells;
// Codes of optical depths towards each light, 16 bits each.
layout(binding = 9) uniform utextureBuffer lightQuads0;
layout(binding = 10) uniform utextureBuffer lightQuads1;
layout(binding = 11) uniform utextureBuffer lightQuads2;
layout(binding = 12) uniform utextureBuffer lightQuads3;
layout(binding = 13) uniform textureBuffer scatteredTexels;  // ScatteredGrid, with kScattered
layout(binding = 14) uniform utextureBuffer gradientTexels;  // packed gradients of blocks, in bricks; not with kPieces

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Holdout { float distances[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer MediumPiece { uvec2 values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Gradients { uint values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer SourcePiece { uvec4 values[]; };

const int kSideA = kAxis == 0 ? 1 : 0;
const int kSideB = kAxis == 2 ? 1 : 2;
const int kPieceLog2 = kPieceBricksLog2 + 3 * kBrickLevels;  // quads
const int kPieceMask = (1 << kPieceLog2) - 1;

struct Ray {
  vec2 origin, slope;   // positions on the sides: origin + slope * slice, in blocks of the level
  float direction;      // 1 for ascending slices, -1 for descending ones
  int group;            // slices that are tested for emptiness together: at most a cell's edge on any axis
  float eye;            // start of the ray, in slices of the level
  float layer;          // world length of the ray in a slice of the level, times the unit of extinction
  vec3 toEye;           // unit vector in world space
  float edge;           // edge of a block in voxels
  float perSlice;       // distance from the eye plane that the ray moves in a slice of the level, world units
  float reach;          // with kHoldout: slices of the level from the eye to the end of the ray
};

// The sizes and strides of a level, read once for each level.
struct LevelGeometry {
  ivec2 dimensions;     // of the sides, in blocks
  int count;
  int firstCell;
  ivec3 cellStrides;    // of the sides and the axis
  int firstSkip;
  ivec3 skipStrides;    // of the sides and the axis
  ivec3 lastSkip;       // of the sides and the axis
  ivec3 first, begin, end;  // with kCube: GatherCube, of the sides and the axis
};

struct Sums {
  vec3 color;
  float distance;       // sum of e times slices from the eye
  float transmittance;
  vec3 colorTransmittance;  // of light, with kTinted; otherwise that is `transmittance`
};

// The values of a ray on a slice, for the stretch to the next slice. blockValuesAt() sets coverage, medium, emission, depths and the
// gradient; scalarValuesAt() sets all but emission, and leaves light and gradient to be found later (hasLight, hasGradient).
struct SliceValues {
  float coverage;  // share of the weights that voxels with data have, 0..1; if it is 0 the other values are undefined
  float scalar;    // in intervals of the transfer function's table
  vec4 integral;   // integrals of extinction times colour (rgb) and of extinction (a) over the scalar
  vec4 medium;     // extinction times colour and extinction at the scalar
  vec3 emission;   // source term of the light that blocks emit, with kEmits
  vec3 light;      // relative to that of a source term of 1
  vec3 gradient;   // gradient of the scalar, or of the extinction, per block in index space
  vec4 depths;     // optical depths towards the lights
  bool hasGradient, hasLight;  // whether `gradient` and `depths` are known
};

// The stretch of a ray between two slices of scalars.
struct Stretch {
  SliceValues end;  // on the second of them
  int slice;        // the second of them
  vec4 near, far;   // extinction times colour and extinction of its halves
  float coverage;   // in its middle
  bool adds;        // whether it adds anything to the sums
};

SliceValues emptySliceValues() {
  SliceValues nothing;
  nothing.coverage = nothing.scalar = 0.0;
  nothing.integral = nothing.medium = vec4(0.0);
  nothing.light = nothing.gradient = nothing.emission = vec3(0.0);
  nothing.hasGradient = nothing.hasLight = false;
  nothing.depths = vec4(0.0);
  return nothing;
}

// The half of a stretch between two slices that ends `end` slices from the eye: the length of it that is in front of the eye and of the
// ray's end (x), the distance of the middle of that from the eye (y), and half its length (z), in slices.
vec3 halfStretch(Ray ray, float end) {
  const float length = clamp(end, 0.0, 0.5);
  if (!kHoldout) return vec3(length, end - 0.25, 0.25);
  const float seen = clamp(ray.reach - (end - length), 0.0, length);
  return vec3(seen, end - length + 0.5 * seen, 0.5 * seen);
}

// On lavapipe, texels are faster than addresses.
uvec2 mediumQuad(int quad) {
  if (!kPieces) return texelFetch(mediumQuads, quad).xy;
  return MediumPiece(frame.axes[kAxis].mediumPieces[quad >> kPieceLog2]).values[quad & kPieceMask];
}

uint packedGradient(int block) {
  return kPieces ? Gradients(frame.gradients).values[block] : texelFetch(gradientTexels, block).x;
}

uvec4 sourceQuad(int quad) {
  if (!kPieces) return texelFetch(sourceQuads, quad);
  return SourcePiece(frame.axes[kAxis].sourcePieces[quad >> kPieceLog2]).values[quad & kPieceMask];
}

uvec4 extraQuad(int quad) {
  if (!kPieces) return texelFetch(extraQuads, quad);
  return SourcePiece(frame.axes[kAxis].extraPieces[quad >> kPieceLog2]).values[quad & kPieceMask];
}

uvec2 lightQuad(int slot, int quad) {
  if (kPieces) return MediumPiece(frame.axes[kAxis].lightPieces[slot][quad >> kPieceLog2]).values[quad & kPieceMask];
  switch (slot) {
    case 0: return texelFetch(lightQuads0, quad).xy;
    case 1: return texelFetch(lightQuads1, quad).xy;
    case 2: return texelFetch(lightQuads2, quad).xy;
    default: return texelFetch(lightQuads3, quad).xy;
  }
}

// The weights of a quad's two neighbours along a side; sets `low` to the quad that has them.
vec2 sideWeights(float position, int count, out int low) {
  const float first = floor(position);
  const float fraction = position - first;
  low = int(first);
  const vec2 weights = low < 0 ? vec2(low == -1 ? fraction : 0.0, 0.0) : vec2(low < count ? 1.0 - fraction : 0.0, fraction);
  low = clamp(low, 0, count - 1);
  return weights;
}

// The number of the brick that has the block at a position on the sides and the axis.
int brickAt(LevelGeometry level, ivec3 block) {
  if (kCube) block -= level.first;
  const ivec3 cell = block >> kBrickLevels;
  return int(texelFetch(brickNumbers, level.firstCell + cell.x * level.cellStrides.x + cell.y * level.cellStrides.y +
                                          cell.z * level.cellStrides.z).x);
}

// The quad of four blocks around a position on a slice, and their weights.
int quadAt(LevelGeometry level, vec2 position, int slice, out vec4 weights) {
  ivec2 low;
  const vec2 a = sideWeights(position.x, level.dimensions.x, low.x);
  const vec2 b = sideWeights(position.y, level.dimensions.y, low.y);
  weights = vec4(a * b.x, a * b.y);
  const ivec3 block = ivec3(low, slice);
  const int brick = brickAt(level, block);
  const ivec3 inBrick = block & (kGatherBrickEdge - 1);
  return ((brick << kBrickLevels | inBrick.y) << kBrickLevels | inBrick.x) << kBrickLevels | inBrick.z;
}

// Whether the stretch that ends at a position on a slice belongs to the cube: the quad around the position begins in the cube, and not among
// the voxels around it. Always, without kCube.
bool isOwn(LevelGeometry level, vec2 position, int slice) {
  if (!kCube) return true;
  const ivec3 block = ivec3(clamp(ivec2(floor(position)), ivec2(0), level.dimensions - 1), slice);
  return all(greaterThanEqual(block, level.begin)) && all(lessThan(block, level.end));
}

// The position in index space of a ray on a slice.
vec3 voxelPosition(Ray ray, float slice) {
  const vec2 sides = ray.origin + ray.slope * slice;
  vec3 position;
  position[kAxis] = slice;
  position[kSideA] = sides.x;
  position[kSideB] = sides.y;
  return (position + 0.5) * ray.edge - 0.5;
}

// The mean of exp(-depth) over a segment along which the depth changes linearly from 0 to x, of either sign. It is multiplied by the
// transmittance at its beginning, which is nothing where x is less than -64.
float meanTransmittance(float x) { return abs(x) < 0.02 ? 1.0 - x * (0.5 - x / 6.0) : (1.0 - exp(-max(x, -64.0))) / x; }

#endif
