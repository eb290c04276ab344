// The stretch of pairs that a workgroup sorts: whole tiles of one pair a thread.
#ifndef RADIX_STRETCH_GLSL
#define RADIX_STRETCH_GLSL
#include "interface.h"

// `count` pairs are sorted in all.
uint stretchLength(uint count) {
  const uint tiles = (count + kSortThreads - 1) / kSortThreads;
  return (tiles + kSortGroups - 1) / kSortGroups * kSortThreads;
}
uint stretchFirst(uint count) { return min(gl_WorkGroupID.x * stretchLength(count), count); }
uint stretchLast(uint count) { return min(stretchFirst(count) + stretchLength(count), count); }

#endif
