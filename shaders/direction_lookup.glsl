// Optical depth from a voxel towards a general direction, from the table's 26 lattice directions: Subr et al.
// 2007, Section 3.3, there with the nearest one. Include after interface.h and attenuation_code.glsl, and
// define PLANE_ADDRESS(direction) as the device address of that direction's codes.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer CodePlane { uint words[]; };

// The order of engine/attenuation/directions.h.
int directionIndex(ivec3 d) {
  const int cell = (d.x + 1) + 3 * (d.y + 1) + 9 * (d.z + 1);
  return cell < 13 ? cell : cell - 1;
}

struct Towards {
  vec3 direction;    // divided by its largest component: a point on the cube's face
  float layer;       // world length of the direction
  mat3 indexToWorld;
  int code;          // kCode...
  int lookup;        // kLookup...
  bool pathLengthCorrection;
};

// As if the line along the stored direction were as long as the one that is asked for: a homogeneous medium
// is exact in every direction.
float storedDepth(Towards towards, ivec3 direction, uint voxel) {
  const uint word = CodePlane(PLANE_ADDRESS(directionIndex(direction))).words[voxel / 4];
  const float depth = decodeDepth(towards.code, bitfieldExtract(word, int(voxel & 3) * 8, 8));
  return towards.pathLengthCorrection ? depth * towards.layer / length(towards.indexToWorld * vec3(direction))
                                      : depth;
}

// Transmittances are interpolated, not depths: one dark direction would darken all.
float depthTowards(Towards towards, uint voxel) {
  const vec3 direction = towards.direction;
  if (towards.lookup == kLookupNearest) return storedDepth(towards, ivec3(round(direction)), voxel);
  const vec3 low = floor(min(direction, 0.999999));
  const vec3 weight = direction - low;
  // The major axis has weight 0 or 1: both of its neighbours are the same face.
  const vec3 size = abs(direction);
  const int major = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int a = (major + 1) % 3;
  const int b = (major + 2) % 3;
  ivec3 d;
  d[major] = direction[major] > 0.0 ? 1 : -1;
  float sum = 0.0;
  [[unroll]] for (int j = 0; j < 2; ++j) {
    [[unroll]] for (int i = 0; i < 2; ++i) {
      d[a] = int(low[a]) + i;
      d[b] = int(low[b]) + j;
      const float share = (i == 0 ? 1.0 - weight[a] : weight[a]) * (j == 0 ? 1.0 - weight[b] : weight[b]);
      sum += share * exp(-storedDepth(towards, d, voxel));
    }
  }
  return -log(sum);
}
