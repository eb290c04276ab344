// The stretch of pairs that this workgroup sorts: whole tiles of one pair a thread. Include after interface.h
// and a buffer with `count`.

uint stretchLength() {
  const uint tiles = (count + kSortThreads - 1) / kSortThreads;
  return (tiles + kSortGroups - 1) / kSortGroups * kSortThreads;
}
uint stretchFirst() { return min(gl_WorkGroupID.x * stretchLength(), count); }
uint stretchLast() { return min(stretchFirst() + stretchLength(), count); }
