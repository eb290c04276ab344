// Transmittance from a voxel towards a general direction, from the directions of the table: Subr et al. 2007,
// Section 3.3, there with the nearest one. Include after interface.h and attenuation_code.glsl, and define
// PLANE_ADDRESS(cell) as the device address of the codes of the direction with that cell number. `cells` is the
// number of cells on the cube's half edge (engine/attenuation/directions.h).
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer CodePlane { uint words[]; };

// As in engine/attenuation/directions.h.
int cellNumber(int cells, ivec3 cell) {
  const int edge = 2 * cells + 1;
  return cell.x + cells + edge * (cell.y + cells + edge * (cell.z + cells));
}

float storedTransmittance(int code, int cells, ivec3 cell, uint voxel) {
  const uint word = CodePlane(PLANE_ADDRESS(cellNumber(cells, cell))).words[voxel / 4];
  return decodeTransmittance(code, bitfieldExtract(word, int(voxel & 3) * 8, 8));
}

// `direction` is divided by its largest component: a point on the cube's face, between four directions of the
// table.
float transmittanceTowards(int code, int lookup, int cells, vec3 direction, uint voxel) {
  const vec3 point = direction * cells;
  if (lookup == kLookupNearest) return storedTransmittance(code, cells, ivec3(round(point)), voxel);
  const vec3 low = floor(min(point, 0.999999 * cells));
  const vec3 weight = point - low;
  // The major axis has weight 0 or 1: both of its neighbours are the same face.
  const vec3 size = abs(direction);
  const int major = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int a = (major + 1) % 3;
  const int b = (major + 2) % 3;
  ivec3 d;
  d[major] = direction[major] > 0.0 ? cells : -cells;
  float sum = 0.0;
  [[unroll]] for (int j = 0; j < 2; ++j) {
    [[unroll]] for (int i = 0; i < 2; ++i) {
      d[a] = int(low[a]) + i;
      d[b] = int(low[b]) + j;
      const float share = (i == 0 ? 1.0 - weight[a] : weight[a]) * (j == 0 ? 1.0 - weight[b] : weight[b]);
      sum += share * storedTransmittance(code, cells, d, voxel);
    }
  }
  return sum;
}
