#version 460
// Third of a digit's three passes: writes every pair to its position; pairs of one value keep their order. A
// bit mask for each value says which threads of the tile have it; a pair's rank is the number of bits before
// its own.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "radix_stretch.glsl"

layout(local_size_x = kSortThreads) in;
layout(scalar, push_constant) uniform Push { RadixPush push; };
layout(scalar, binding = 0) readonly buffer Count { uint count; };
layout(scalar, binding = 1) readonly buffer Keys { uint keys[]; };
layout(scalar, binding = 2) readonly buffer Values { uint values[]; };
layout(scalar, binding = 3) readonly buffer Offsets { uint offsets[]; };  // [group][digit]
layout(scalar, binding = 4) writeonly buffer SortedKeys { uint sortedKeys[]; };
layout(scalar, binding = 5) writeonly buffer SortedValues { uint sortedValues[]; };

const uint kWords = kSortThreads / 32;
shared uint next[kSortDigits];  // position of the stretch's next pair with this value
shared uint masks[kWords][kSortDigits];

void main() {
  const uint thread = gl_LocalInvocationIndex;
  const uint word = thread / 32, bit = thread % 32;
  next[thread] = offsets[gl_WorkGroupID.x * kSortDigits + thread];
  for (uint w = 0; w < kWords; ++w) masks[w][thread] = 0;
  barrier();

  const uint last = stretchLast(count);
  for (uint tile = stretchFirst(count); tile < last; tile += kSortThreads) {
    const uint i = tile + thread;
    const bool mine = i < last;
    const uint key = mine ? keys[i] : 0;
    const uint digit = (key >> push.shift) & (kSortDigits - 1);
    if (mine) atomicOr(masks[word][digit], 1u << bit);
    barrier();

    uint rank = 0, inTile = 0;
    if (mine) {
      for (uint w = 0; w < kWords; ++w) {
        const uint mask = masks[w][digit];
        inTile += bitCount(mask);
        rank += w < word ? bitCount(mask) : w == word ? bitCount(mask & ((1u << bit) - 1)) : 0;
      }
      sortedKeys[next[digit] + rank] = key;
      sortedValues[next[digit] + rank] = values[i];
    }
    barrier();

    if (mine && rank + 1 == inTile) {
      next[digit] += inTile;
      for (uint w = 0; w < kWords; ++w) masks[w][digit] = 0;
    }
    barrier();
  }
}
