#version 460
// Second of a digit's three passes, one workgroup with a thread for each value of the digit: turns counts
// into the positions at which each workgroup's keys with that value are written. Smaller values come first,
// then earlier stretches.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(local_size_x = kSortThreads) in;
layout(scalar, binding = 0) buffer Offsets { uint offsets[]; };  // [group][digit]

shared uint totals[kSortDigits];

void main() {
  const uint digit = gl_LocalInvocationIndex;
  uint total = 0;
  for (uint group = 0; group < kSortGroups; ++group) total += offsets[group * kSortDigits + digit];
  totals[digit] = total;
  barrier();
  uint offset = 0;
  for (uint smaller = 0; smaller < digit; ++smaller) offset += totals[smaller];
  for (uint group = 0; group < kSortGroups; ++group) {
    const uint found = offsets[group * kSortDigits + digit];
    offsets[group * kSortDigits + digit] = offset;
    offset += found;
  }
}
