// The light that a point scatters towards the eye of what was scattered before, comes from the surroundings or is emitted, for albedo 1:
// interpolated trilinearly between the centres of cells (scattering_texels.comp), and constant beyond the outermost ones.
// Includers define SCATTERED_TEXEL(i), the texel with index i.
#ifndef SCATTERED_LIGHT_GLSL
#define SCATTERED_LIGHT_GLSL
#include "frame_interface.h"

// `flux` says whether there is a phase function; `voxel` is in index space, `toEye` a unit vector in world space.
vec3 scatteredLightAt(ScatteredGrid grid, bool flux, vec3 voxel, vec3 toEye) {
  const vec3 position = clamp(grid.toCells * (voxel + 0.5) + grid.firstCell, vec3(0.0), vec3(grid.cells - 1));
  const ivec3 low = ivec3(position), up = min(low + 1, grid.cells - 1) - low;
  const vec3 part = position - vec3(low);
  const ivec3 strides = ivec3(1, grid.cells.x, grid.cells.x * grid.cells.y);
  const int first = low.x + low.y * strides.y + low.z * strides.z;
  const vec3 towards = grid.flux * toEye;
  vec3 sum = vec3(0.0);
  [[unroll]] for (int corner = 0; corner < 8; ++corner) {
    const ivec3 upper = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const vec3 shares = mix(1.0 - part, part, vec3(upper));
    const ivec3 steps = upper * up * strides;
    const int place = first + steps.x + steps.y + steps.z;
    const float weight = shares.x * shares.y * shares.z;
    if (!flux) {
      sum += weight * SCATTERED_TEXEL(place).rgb;
    } else {
      vec3 light = SCATTERED_TEXEL(4 * place).rgb;
      [[unroll]] for (int axis = 0; axis < 3; ++axis) light += towards[axis] * SCATTERED_TEXEL(4 * place + 1 + axis).rgb;
      sum += weight * light;
    }
  }
  return grid.share * max(sum, 0.0);
}

#endif
