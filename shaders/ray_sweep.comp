#version 460
// Optical depth along the rays of a face (engine/scene/source_rays.h), a thread for each ray: at every plane
// of voxels the depth of the planes before it. Subr et al. 2007, Eq. 5, along rays instead of lattice lines.
// A dispatch marches through a slab of planes and stores the depths for the next.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_samplerless_texture_functions : require
#define TRANSFER_TABLE_BINDING 2
#include "ray_pair.glsl"
#include "transfer_table.glsl"

// Whether extinction is classified after interpolation: depths are then those up to the planes, from scalars
// that change linearly between planes. Otherwise they are those in front of the planes' layers, each with the
// extinction of its plane.
layout(constant_id = 0) const bool kScalars = false;
// Whether rays begin with the depths that are carried, those of what is between the volume and the source, and end with all depths in there.
layout(constant_id = 1) const bool kBetween = false;
// Whether it is known which cells of kSkipGroup^3 voxels are far from all occupied ones, so that rays need not look at their voxels.
layout(constant_id = 2) const bool kSkips = false;

// Whether only some groups of kRaySweepThreads rays are marched, as the others meet nothing in this slab, and nobody reads their depths there.
layout(constant_id = 3) const bool kListed = false;

layout(local_size_x = kRaySweepThreads) in;
layout(scalar, push_constant) uniform Push { RaySweepPush given; };
RaySweepPush push;  // copied once, as lavapipe loads uniforms lane by lane
layout(binding = 0) uniform samplerBuffer extinction;  // extinction of the slab's voxels, with 0 around the volume; or scalars
layout(scalar, binding = 1) buffer Carried { float carried[]; };  // depth between slabs, by ray
layout(binding = 3) uniform utextureBuffer nearOccupied;  // a byte by cell: 1 if it or one of its 26 neighbours is occupied, otherwise 0
layout(scalar, binding = 4) readonly buffer CellCounts { ivec3 cellCounts; };  // along the axes
layout(scalar, binding = 5) readonly buffer Groups { uint groupCount, groups[]; };  // numbers of those that are marched
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Depths { uint pairs[]; };

// The first of the four voxels around a position on a plane, which is counted from the first of the face; `weights` are those of the
// others along the two sides. Beyond the volume the border of one voxel is 0, and so is everything farther out.
int firstAround(int plane, vec2 position, out vec2 weights) {
  const vec2 near = clamp(position, vec2(-1.0), vec2(push.sides));
  const vec2 low = min(floor(near), vec2(push.sides - 1));
  weights = near - low;
  return push.slab.origin + plane * push.slab.planeStride + int(low.x) * push.slab.strideA + int(low.y) * push.slab.strideB;
}

float interpolated(int plane, vec2 position) {
  vec2 w;
  const int first = firstAround(plane, position, w);
  const int a = push.slab.strideA, b = push.slab.strideB;
  return mix(mix(texelFetch(extinction, first).x, texelFetch(extinction, first + a).x, w.x),
             mix(texelFetch(extinction, first + b).x, texelFetch(extinction, first + a + b).x, w.x), w.y);
}

// The scalar of a ray on a plane.
struct PlaneScalar {
  float coverage, scalar;
  vec4 integral, medium;
};

PlaneScalar scalarAt(int plane, vec2 position) {
  vec2 w;
  const int first = firstAround(plane, position, w);
  const int a = push.slab.strideA, b = push.slab.strideB;
  const vec4 scalars = vec4(texelFetch(extinction, first).x, texelFetch(extinction, first + a).x,
                            texelFetch(extinction, first + b).x, texelFetch(extinction, first + a + b).x);
  vec4 weights = vec4((1.0 - w.x) * (1.0 - w.y), w.x * (1.0 - w.y), (1.0 - w.x) * w.y, w.x * w.y);
  weights *= vec4(greaterThanEqual(scalars, vec4(0.0)));
  PlaneScalar found;
  found.coverage = weights.x + weights.y + weights.z + weights.w;
  found.scalar = max(dot(weights, scalars) / max(found.coverage, 1e-20), 0.0);
  tableAt(found.scalar, found.integral, found.medium);
  return found;
}

// The mean extinction between two planes.
float meanOf(PlaneScalar before, PlaneScalar after) {
  if (before.coverage == 0.0) before = after;
  if (after.coverage == 0.0) after = before;
  return 0.5 * (before.coverage + after.coverage) *
         meanBetween(before.scalar, before.integral, before.medium, after.scalar, after.integral, after.medium).a;
}

// Number of layers, at most one, between the source and the first plane.
float layersToFirst() {
  const FaceRays fan = push.fan;
  return fan.convergence == 0.0 ? 1.0 : min(abs(float(fan.firstPlane) - fan.farthest + 1.0 / fan.convergence), 1.0);
}

ivec3 cells;  // cellCounts, once for each ray, as lavapipe reads buffers lane by lane

const int kGroupPairs = kSkipGroup / 2;  // pairs of planes that are skipped together: as many planes as a cell has voxels along its edge
// Largest slope of a ray from whose position in the middle of a group the voxels that it reads there, and on the plane before, are in the
// same cell or its neighbours.
const float kMaxSkipSlope = 1.1;

// A ray on its way from plane to plane.
struct March {
  uint ray;
  vec2 atFirst, perPlane;  // position on the first plane, and step to the next one
  float layer;             // world length of that step
  int pair, end;           // the next pair of planes, and the first that is not marched any more
  float depth;             // up to the plane before the next pair
  PlaneScalar last;        // on that plane, with kScalars
};

// Whether nothing is near a ray on the planes of a group and on the one before them, nor in the stretches between these.
bool isEmptyGroup(March march, int group) {
  if (!kSkips || max(abs(march.perPlane.x), abs(march.perPlane.y)) > kMaxSkipSlope) return false;
  const float plane = float(2 * kGroupPairs * group) + 0.5 * float(2 * kGroupPairs - 1);
  vec3 place;
  place[push.fan.axis] = float(push.fan.firstPlane) + float(push.fan.direction) * plane;
  const vec2 side = march.atFirst + march.perPlane * plane;
  place[(push.fan.axis + 1) % 3] = side.x;
  place[(push.fan.axis + 2) % 3] = side.y;
  const ivec3 cell = clamp(ivec3(floor(place)) >> kSkipLevels, ivec3(0), cells - 1);
  return texelFetch(nearOccupied, cell.x + cells.x * (cell.y + cells.y * cell.z)).x == 0;
}

void storeDepths(uint ray, int pair, vec2 depths) {
  Depths(pairAddress(push.fan, pair)).pairs[ray] = packUnorm2x16(sqrt(clamp(depths / kOpaqueDepth, 0.0, 1.0)));
}

int endOfGroup(March march) { return min((march.pair / kGroupPairs + 1) * kGroupPairs, march.end); }

// Stores the depth of groups of planes where it does not change, because they are empty, or need not be known, because nothing comes through.
// Loops have the form of gather_march.glsl.
void passOver(inout March march) {
  int stopped = -1;  // the pair that has to be marched
  do {
    if (stopped != march.pair && march.pair < march.end) {
      const bool passes = march.depth >= kOpaqueDepth || isEmptyGroup(march, march.pair / kGroupPairs);
      const int end = passes ? endOfGroup(march) : march.pair;
      [[unroll]] for (int i = 0; i < kGroupPairs; ++i)
        if (march.pair + i < end) storeDepths(march.ray, march.pair + i, vec2(march.depth));
      if (passes) march.last.coverage = 0.0;  // nothing is in the stretch from there, as nothing is in the cells beside the group
      stopped = passes ? stopped : march.pair;
      march.pair = end;
    }
  } while (stopped != march.pair && march.pair < march.end);
}

void marchGroup(inout March march) {
  const int end = endOfGroup(march);
  do {
    if (march.pair < end) {
      vec2 planeDepths;
      [[unroll]] for (int i = 0; i < 2; ++i) {
        const int plane = 2 * march.pair + i;
        const vec2 position = march.atFirst + march.perPlane * float(plane);
        if (kScalars) {
          const PlaneScalar found = scalarAt(plane, position);
          march.depth += march.layer * (plane == 0 ? layersToFirst() : 1.0) * meanOf(march.last, found);
          march.last = found;
        }
        planeDepths[i] = march.depth;
        if (!kScalars) march.depth += march.layer * interpolated(plane, position);
      }
      storeDepths(march.ray, march.pair, planeDepths);
      ++march.pair;
    }
  } while (march.pair < end);
}

// The range of planes, counted from the first, within which the ray is near enough to the volume to be looked
// up: x to y.
ivec2 planesWithin(vec2 atFirst, vec2 perPlane) {
  float enter = 0.0, leave = float(push.fan.planeCount - 1);
  const vec2 high = vec2(push.sides) + 1.0;
  [[unroll]] for (int side = 0; side < 2; ++side) {
    const float reach = 2.0 + 2.0 * push.fan.spacing;
    const float slope = abs(perPlane[side]) < 1e-7 ? 1e-7 : perPlane[side];
    const float t0 = (-reach - atFirst[side]) / slope, t1 = (high[side] + reach - atFirst[side]) / slope;
    enter = max(enter, min(t0, t1));
    leave = min(leave, max(t0, t1));
  }
  return ivec2(floor(min(enter, float(push.fan.planeCount))), ceil(max(leave, -1.0)));
}

// For a ray that starts inside the volume, the path in front of its first layer, in layers: the extinction
// along it is linear between the planes on both sides of the source. Negative if the source is in that layer.
float sourceCut(vec2 atFirst, vec2 perPlane) {
  if (push.fan.convergence == 0.0) return 0.0;
  const float distance = layersToFirst();
  const float first = interpolated(0, atFirst);
  const float before = interpolated(-1, atFirst - perPlane);
  return 0.5 * (distance * (mix(first, before, distance) + first) - first);
}

void main() {
  push = given;
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (kListed && group >= groupCount) return;
  const uint ray = gl_LocalInvocationID.x + kRaySweepThreads * (kListed ? groups[group] : group);
  if (kSkips) cells = cellCounts;
  const FaceRays fan = push.fan;
  const uint rays = uint(fan.rayCount.x * fan.rayCount.y);
  if (ray >= rays) return;

  const vec2 offset = fan.spacing * vec2(ray % fan.rayCount.x, ray / fan.rayCount.x);
  const vec2 slope = fan.slope + offset * fan.convergence;  // per step along the positive axis
  const vec2 atFirst = fan.origin + offset + slope * (float(fan.firstPlane) - fan.farthest);
  const vec2 perPlane = slope * float(fan.direction);
  vec3 layerStep;
  layerStep[fan.axis] = 1.0;
  layerStep[(fan.axis + 1) % 3] = slope.x;
  layerStep[(fan.axis + 2) % 3] = slope.y;
  const float layer = length(push.indexToWorld * layerStep);

  const ivec2 planes = planesWithin(atFirst, perPlane);
  const int begin = push.slab.begin / 2, end = (push.slab.end + 1) / 2;
  March march;
  march.ray = ray;
  march.atFirst = atFirst;
  march.perPlane = perPlane;
  march.layer = layer;
  march.pair = max(planes.x / 2, begin);
  march.end = min(planes.y / 2 + 1, end);
  if (march.pair >= march.end) return;
  march.depth = 0.0;
  if (planes.x / 2 < begin)
    march.depth = carried[ray];
  else if (planes.x == 0 && !kScalars)
    march.depth = layer * sourceCut(atFirst, perPlane);
  if (kBetween && planes.x / 2 >= begin) march.depth += carried[ray];
  if (kScalars) march.last = scalarAt(2 * march.pair - 1, atFirst + perPlane * float(2 * march.pair - 1));
  do {
    if (march.pair < march.end) {
      passOver(march);
      marchGroup(march);
    }
  } while (march.pair < march.end);
  if (kBetween || push.slab.end < fan.planeCount) carried[ray] = march.depth;
}
