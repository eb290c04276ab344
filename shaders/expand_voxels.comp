#version 460
// Writes the extinction of all voxels of a box, which may reach beyond the volume. A thread writes four
// voxels of a row.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "blocks.glsl"
#include "rank.glsl"

layout(local_size_x = kExpandTile, local_size_y = kExpandTile) in;
layout(scalar, push_constant) uniform Push { ExpandPush push; };
layout(binding = 0) uniform usamplerBuffer occupancy;
layout(binding = 1) uniform samplerBuffer extinction;  // by rank
layout(scalar, binding = 2) writeonly buffer BoxExtinction { vec4 boxExtinction[]; };

// Four consecutive extinctions, starting at this rank.
vec4 fourFrom(uint rank) {
  const vec4 low = texelFetch(extinction, int(rank / 4)), high = texelFetch(extinction, int(rank / 4 + 1));
  const bool two = (rank & 2u) != 0, one = (rank & 1u) != 0;
  const vec4 some = two ? vec4(low.zw, high.xy) : low;
  return one ? vec4(some.yzw, two ? high.z : high.x) : some;
}

void main() {
  const ivec3 place = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(place, push.extent))) return;
  const ivec3 voxel = push.first + ivec3(4 * place.x, place.yz);
  const bool inside = all(greaterThanEqual(voxel, ivec3(0))) &&
                      all(lessThan(voxel, ivec3(push.voxels.rowPitch, push.voxels.dimensions.yz)));
  vec4 quad = vec4(0.0);
  if (inside) {
    const uint address = blockAddress(push.voxels, voxel);
    const uvec2 word = texelFetch(occupancy, int(address / kBlocksPerWord)).xy;
    const int bit = int(address % kBlocksPerWord);
    const uint mask = bitfieldExtract(word.x, bit, 4);
    if (mask != 0) {
      // A voxel's rank is one more than that of the occupied voxel before it.
      const vec4 held = fourFrom(push.voxels.firstRank + rankIn(word, bit));
      const bvec4 holds = notEqual(mask & uvec4(1, 2, 4, 8), uvec4(0));
      const float second = holds.x ? held.y : held.x;
      const float third = holds.x ? (holds.y ? held.z : held.y) : (holds.y ? held.y : held.x);
      const uint before = bitCount(mask & 7u);
      const float fourth = before < 2 ? (before == 0 ? held.x : held.y) : (before == 2 ? held.z : held.w);
      quad = mix(vec4(0.0), vec4(held.x, second, third, fourth), holds);
    }
  }
  boxExtinction[place.x + push.extent.x * (place.y + push.extent.y * place.z)] = quad;
}
