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
// Whether cells of 4^3 voxels are known that are far from all content, so that rays need not look at their voxels.
layout(constant_id = 2) const bool kSkips = false;

layout(local_size_x = kRaySweepThreads) in;
layout(scalar, push_constant) uniform Push { RaySweepPush push; };
layout(binding = 0) uniform samplerBuffer extinction;  // extinction of the slab's voxels, with 0 around the volume; or scalars
layout(scalar, binding = 1) buffer Carried { float carried[]; };  // depth between slabs, by ray
layout(binding = 3) uniform utextureBuffer nearContent;  // a byte by cell: whether it or one of its 26 neighbours has content
layout(scalar, binding = 4) readonly buffer ContentSize { ivec3 contentCells; };
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

const int kGroupPairs = 2;  // pairs of planes that are skipped together: as many planes as a cell has voxels
// Largest slope of a ray from whose position in the middle of a group the voxels that it reads there, and on the plane before, are in the
// same cell or its neighbours.
const float kMaxSkipSlope = 1.1;

// Whether nothing is near a ray on the planes of a group and on the one before them, nor in the stretches between these.
bool isEmptyGroup(int group, vec2 atFirst, vec2 perPlane, ivec3 cells) {
  const float plane = float(2 * kGroupPairs * group) + 0.5 * float(2 * kGroupPairs - 1);
  vec3 place;
  place[push.fan.axis] = float(push.fan.firstPlane) + float(push.fan.direction) * plane;
  const vec2 side = atFirst + perPlane * plane;
  place[(push.fan.axis + 1) % 3] = side.x;
  place[(push.fan.axis + 2) % 3] = side.y;
  const ivec3 cell = clamp(ivec3(floor(place)) >> 2, ivec3(0), cells - 1);
  return texelFetch(nearContent, cell.x + cells.x * (cell.y + cells.y * cell.z)).x == 0;
}

uint packDepths(vec2 depths) { return packUnorm2x16(sqrt(clamp(depths / kOpaqueDepth, 0.0, 1.0))); }

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
  const uint ray = gl_LocalInvocationID.x + kRaySweepThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x);
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
  int pair = max(planes.x / 2, begin);
  const int behind = min(planes.y / 2 + 1, end);
  if (pair >= behind) return;
  float depth = 0.0;
  if (planes.x / 2 < begin)
    depth = carried[ray];
  else if (planes.x == 0 && !kScalars)
    depth = layer * sourceCut(atFirst, perPlane);
  if (kBetween && planes.x / 2 >= begin) depth += carried[ray];
  PlaneScalar last;
  if (kScalars) last = scalarAt(2 * pair - 1, atFirst + perPlane * float(2 * pair - 1));
  const ivec3 cells = kSkips ? contentCells : ivec3(1);
  const bool maySkip = kSkips && max(abs(perPlane.x), abs(perPlane.y)) <= kMaxSkipSlope;
  // Alternates between two steps until no plane is left: (1) stores the depth of groups of planes where it does not change, because they are
  // empty, or need not be known, because nothing comes through; (2) marches one group. Loops have the form of gather_march.glsl.
  do {
    if (pair < behind) {
      int lastEnd = -1;
      do {
        if (lastEnd != pair && pair < behind) {
          const int group = pair / kGroupPairs;
          const bool skips = depth >= kOpaqueDepth || (maySkip && isEmptyGroup(group, atFirst, perPlane, cells));
          const int end = skips ? min((group + 1) * kGroupPairs, behind) : pair;
          const uint codes = packDepths(vec2(depth));
          [[unroll]] for (int i = 0; i < kGroupPairs; ++i)
            if (pair + i < end) Depths(pairAddress(fan, pair + i)).pairs[ray] = codes;
          if (skips) last.coverage = 0.0;  // the stretch from there has nothing, as the cells beside this group have nothing
          lastEnd = skips ? lastEnd : pair;
          pair = end;
        }
      } while (lastEnd != pair && pair < behind);
      const int end = min((pair / kGroupPairs + 1) * kGroupPairs, behind);
      do {
        if (pair < end) {
          vec2 planeDepths;
          [[unroll]] for (int i = 0; i < 2; ++i) {
            const int plane = 2 * pair + i;
            if (kScalars) {
              const PlaneScalar found = scalarAt(plane, atFirst + perPlane * float(plane));
              depth += layer * (plane == 0 ? layersToFirst() : 1.0) * meanOf(last, found);
              last = found;
            }
            planeDepths[i] = depth;
            if (!kScalars) depth += layer * interpolated(plane, atFirst + perPlane * float(plane));
          }
          Depths(pairAddress(fan, pair)).pairs[ray] = packDepths(planeDepths);
          ++pair;
        }
      } while (pair < end);
    }
  } while (pair < behind);
  if (kBetween || push.slab.end < fan.planeCount) carried[ray] = depth;
}
