// The exclusive prefix sum of one count per thread of a workgroup. Parameter: COUNT_THREADS, the number of threads.
#ifndef COUNT_BEFORE_GLSL
#define COUNT_BEFORE_GLSL

const uint kStretch = 8;  // threads whose counts are summed up first, so that each thread adds few

shared uint counts[COUNT_THREADS], sums[COUNT_THREADS / kStretch];

// All threads of the workgroup call it.
uint countBefore(uint thread, uint count) {
  counts[thread] = count;
  barrier();
  if (thread < COUNT_THREADS / kStretch) {
    uint sum = 0;
    for (uint i = 0; i < kStretch; ++i) sum += counts[thread * kStretch + i];
    sums[thread] = sum;
  }
  barrier();
  uint before = 0;
  for (uint i = 0; i < thread / kStretch; ++i) before += sums[i];
  for (uint i = thread - thread % kStretch; i < thread; ++i) before += counts[i];
  return before;
}

#endif
