// Optical depth from a block towards a general direction, from the directions of the table: Subr et al. 2007,
// Section 3.3 (which takes the nearest one). Binding PLANE_ADDRESSES_BINDING has the device address of each
// direction's codes by cell number.
#ifndef DIRECTION_LOOKUP_GLSL
#define DIRECTION_LOOKUP_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "attenuation_code.glsl"
#include "major_axis.glsl"
#ifndef PLANE_ADDRESSES_BINDING
#error "Define PLANE_ADDRESSES_BINDING, the binding of the addresses of the planes, before including direction_lookup.glsl."
#endif

layout(scalar, binding = PLANE_ADDRESSES_BINDING) readonly buffer PlaneAddresses { uvec2 planeAddresses[]; };

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer CodePlane { uint words[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer DepthsBeyond { float layers[]; };

struct TableLookup {
  vec3 direction;  // divided by its largest component: a point on a face of the cube
  float layer;     // world length of the direction
  mat3 indexToWorld;
  int cells;       // cells along half an edge of the cube (engine/scene/directions.h)
  int code;        // kCode...
  int lookup;      // kLookup...
  bool pathLengthCorrection;
  float countedLength;  // world length of a layer in stored depths
  uvec2 beyond;         // device address of the output of eye_depths.comp; 0 if nothing lies beyond the source
};

// As in engine/scene/directions.h.
int cellNumber(int cells, ivec3 cell) {
  const int edge = 2 * cells + 1;
  return cell.x + cells + edge * (cell.y + cells + edge * (cell.z + cells));
}

uint codeAt(uvec2 plane, uint rank) {
  return bitfieldExtract(CodePlane(plane).words[rank / 4], int(rank & 3) * 8, 8);
}

uint storedCode(TableLookup towards, ivec3 cell, uint rank) {
  return codeAt(planeAddresses[cellNumber(towards.cells, cell)], rank);
}

// Scales a stored depth by the length of the requested line over that of the stored one, so that a
// homogeneous medium is exact in every direction.
float storedDepth(TableLookup towards, ivec3 cell, uint rank) {
  const float depth = decodeDepth(towards.code, storedCode(towards, cell, rank));
  if (!towards.pathLengthCorrection) return depth;
  return depth * towards.layer * float(towards.cells) / length(towards.indexToWorld * vec3(cell));
}

// The depth beyond an eye or a light inside the volume: A_B / A_V of Subr et al. 2007, Section 3.3.
float depthBeyond(TableLookup towards, ivec3 cell) {
  if (towards.beyond == uvec2(0)) return 0.0;
  return DepthsBeyond(towards.beyond).layers[cellNumber(towards.cells, cell)] * towards.countedLength;
}

float depthUpTo(TableLookup towards, ivec3 cell, uint rank) {
  return max(storedDepth(towards, cell, rank) - depthBeyond(towards, cell), 0.0);
}

// Whether a stored depth is the end of the code. The true depth may be larger, and is stored with the same
// value a layer before.
bool isAtEnd(TableLookup towards, ivec3 cell, uint rank) {
  return storedCode(towards, cell, rank) == (towards.code == kCodeLinear8 ? 0 : 255);
}

// Halves go towards 0, as in nearestDirection() of engine/scene/directions.h; GLSL's round() may take them either way.
ivec3 nearestCell(vec3 point) { return ivec3(sign(point) * ceil(abs(point) - 0.5)); }

// Interpolates between four table directions. Transmittances are interpolated, not depths: one dark direction
// would otherwise darken all. `unsaturated` is the fraction of the transmittance that comes from directions
// whose code is not at its end: only this part increases towards the eye from layer to layer.
float depthTowards(TableLookup towards, uint rank, out float unsaturated) {
  // The division may round to slightly more than 1.
  const vec3 point = clamp(towards.direction, -1.0, 1.0) * towards.cells;
  if (towards.lookup == kLookupNearest) {
    unsaturated = isAtEnd(towards, nearestCell(point), rank) ? 0.0 : 1.0;
    return depthUpTo(towards, nearestCell(point), rank);
  }
  const vec3 low = floor(min(point, 0.999999 * towards.cells));
  const vec3 weight = point - low;
  // The major axis has weight 0 or 1, because both of its neighbours are on the same face.
  const int major = majorAxis(point);
  const int a = (major + 1) % 3;
  const int b = (major + 2) % 3;
  ivec3 cell;
  cell[major] = point[major] > 0.0 ? towards.cells : -towards.cells;
  float sum = 0.0, unsaturatedSum = 0.0;
  [[unroll]] for (int j = 0; j < 2; ++j) {
    [[unroll]] for (int i = 0; i < 2; ++i) {
      cell[a] = int(low[a]) + i;
      cell[b] = int(low[b]) + j;
      const float share = (i == 0 ? 1.0 - weight[a] : weight[a]) * (j == 0 ? 1.0 - weight[b] : weight[b]);
      const float transmittance = share * exp(-depthUpTo(towards, cell, rank));
      sum += transmittance;
      if (!isAtEnd(towards, cell, rank)) unsaturatedSum += transmittance;
    }
  }
  unsaturated = unsaturatedSum / sum;
  return -log(sum);
}

#endif
