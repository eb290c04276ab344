// The sums of the bricks of a part (GatherPart), in fixed point.
#ifndef GATHER_PARTS_GLSL
#define GATHER_PARTS_GLSL
#include "fixed_point.glsl"
#include "gather_march.glsl"
#include "ray_lookup.glsl"

// The transmittance between the eye and a position on a ray, in slices of the level, from the eye's rays. These are stored on planes across
// one axis, which may differ from the axis of this ray's slices; the depth is then interpolated between the two planes around the position.
float transmittanceBefore(Ray ray, float slice) {
  if ((slice - ray.eye) * ray.direction <= 0.0) return 1.0;
  vec3 along;
  along[kAxis] = ray.direction;
  along[kSideA] = ray.slope.x * ray.direction;
  along[kSideB] = ray.slope.y * ray.direction;
  const FaceRays fan = frame.part.fans[fanIndex(along)];
  const vec3 layer = along / abs(along[fan.axis]);
  // Depths in front of a layer are those half a layer before its plane.
  const vec3 position = voxelPosition(ray, slice) + (kScalars ? 0.0 : 0.5) * layer;
  const float plane = (position[fan.axis] - float(fan.firstPlane)) * float(fan.direction);
  const float fraction = max(plane - floor(plane + 1e-3), 0.0);
  const float before = rayTransmittance(fan, position - fraction * layer);
  if (fraction < 1e-3) return before;
  return pow(max(before, 1e-30), 1.0 - fraction) * pow(max(rayTransmittance(fan, position + (1.0 - fraction) * layer), 1e-30), fraction);
}

// Adds the sums of the last brick to those of the part.
void endBrick(inout Sums sums, Ray ray) {
  if (sums.brick == 0) return;
  const GatherPart part = frame.part;
  [[unroll]] for (int c = 0; c < 3; ++c)
    partSums[c] = addFixed(partSums[c], frame.sourceUnit * sums.color[c], part.colorDigits, partFits);
  partSums[3] = addFixed(partSums[3], sums.begin - sums.transmittance, part.energyDigits, partFits);
  partSums[4] = addFixed(partSums[4], min(sums.depth, kMaxBrickDepth), part.depthDigits, partFits);
  partSums[5] = addFixed(partSums[5], ray.perSlice * sums.distance, part.distanceDigits, partFits);
  sums.brick = 0;
}

// Begins the sums of a brick where the ray first meets its medium, from the position `slice` on.
void enterBrick(inout Sums sums, Ray ray, int brick, float slice) {
  if (sums.brick == brick) return;
  endBrick(sums, ray);
  sums.brick = brick;
  sums.color = vec3(0.0);
  sums.distance = sums.depth = 0.0;
  sums.begin = sums.transmittance = transmittanceBefore(ray, slice);
}

void storePart(ivec2 index) {
  const int sampleIndex = index.x + frame.seenExtent.x * index.y, samples = frame.seenExtent.x * frame.seenExtent.y;
  PartSums sums = PartSums(frame.part.sums);
  [[unroll]] for (int c = 0; c < 6; ++c)
    sums.values[c * samples + sampleIndex] = partSums[c];
  if (!partFits) atomicOr(Overflow(frame.part.overflow).overflow, 1u);
}

#endif
