// Surfaces: normals from gradients, and the light that reaches a surface from outside.
#ifndef GATHER_SURFACES_GLSL
#define GATHER_SURFACES_GLSL
#include "gather_light.glsl"
#include "packed_gradient.glsl"

const float kMinShaded = 1.0 / 512.0;  // least share of a pixel for which the normal of a surface is computed
const float kOutside = 2.5;            // blocks from a surface at which the light that reaches it is looked up

// The gradient at a position on a slice; beyond the volume that of its border.
vec3 gradientAt(LevelGeometry level, vec2 position, int slice) {
  position = clamp(position, vec2(0.0), vec2(level.dimensions - 1));
  ivec2 low;
  const vec2 a = sideWeights(position.x, level.dimensions.x, low.x);
  const vec2 b = sideWeights(position.y, level.dimensions.y, low.y);
  const vec4 weights = vec4(a * b.x, a * b.y);
  vec3 gradient = vec3(0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    const ivec3 neighbour = min(ivec3(low + ivec2(i & 1, i >> 1), slice), ivec3(level.dimensions, slice + 1) - 1);
    const int brick = brickAt(level, neighbour);
    const ivec3 inBrick = neighbour & (kGatherBrickEdge - 1);
    ivec3 block;
    block[kAxis] = inBrick.z;
    block[kSideA] = inBrick.x;
    block[kSideB] = inBrick.y;
    const int index = ((brick << kBrickLevels | block.z) << kBrickLevels | block.y) << kBrickLevels | block.x;
    gradient += weights[i] * unpackGradient(packedGradient(index));
  }
  return gradient;
}

// Finds the gradients at the ends of a stretch. The first end has its own already if another stretch ended there. What the loop's body
// assigns is the same if a lane that has left repeats it, which is faster here than an `if` around it; but loads from addresses (kPieces)
// would then return 0, so that all lanes stay for both ends.
void findGradients(inout SliceValues last, inout SliceValues found, LevelGeometry level, Ray ray, int slice) {
  bool first = !last.hasGradient, again, begun = false;
  do {
    const int at = clamp(first ? slice - int(ray.direction) : slice, 0, level.count - 1);
    const vec3 gradient = gradientAt(level, ray.origin + ray.slope * float(at), at);
    if (first)
      last.gradient = gradient;
    else
      found.gradient = gradient;
    again = kPieces ? !begun : first;
    first = false;
    begun = true;
  } while (again);
  last.hasGradient = found.hasGradient = true;
}

vec3 normalOf(vec3 gradient) {
  const vec3 normal = kept.gradientToWorld * gradient;
  return normal * inversesqrt(max(dot(normal, normal), 1e-30));
}

// `decrease` is the decrease of the extinction along a gradient, from one block before to one block behind,
// relative to the larger of the two.
void setSurface(inout SegmentLight lit, vec3 gradient, float decrease) {
  lit.normal = normalOf(sign(decrease) * gradient);
  lit.surface = kept.surface * min(2.0 * abs(decrease), 1.0);
}

// A point kOutside blocks outside of a surface, and the optical depths there. At the surface itself its own voxels would cast steps of shadow;
// whether it faces the light follows from its normal.
struct Outside {
  vec4 depths;
  vec3 offset;  // from the surface, voxels
};

Outside outsideOf(LevelGeometry level, Ray ray, float slice, vec3 outwards) {
  // Less on rays that move by more than a block a slice, so that the place is in the bricks, which reach a cell beyond occupied ones.
  const float outside = kOutside - 0.5 * max(max(abs(ray.slope.x), abs(ray.slope.y)) - 1.0, 0.0);
  const vec3 offset = outside * outwards * inversesqrt(max(dot(outwards, outwards), 1e-30));
  const vec2 position = ray.origin + ray.slope * slice + vec2(offset[kSideA], offset[kSideB]);
  vec4 weights;
  const int quad = quadAt(level, position, clamp(int(floor(slice + offset[kAxis] + 0.5)), 0, level.count - 1), weights);
  vec4 depths = depthsTowardsLights(quad, weights);
  if (kClips) passClipped(depths, level, voxelPosition(ray, slice) + ray.edge * offset, ray.edge, kScalars && ray.edge == 1.0 ? 1.0 : 0.0);
  return Outside(depths, ray.edge * offset);
}

void lightFrom(inout SegmentLight lit, Outside outside) {
  lit.outside = outside.depths;
  lit.scatteredOffset = lit.surface * outside.offset;
}

#endif
