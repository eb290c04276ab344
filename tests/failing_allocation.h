#pragma once
// Want of memory at a chosen place: only programs that are linked with failing_allocation.cpp have it.

#include <cstddef>

namespace freevoxels::test {

/// As long as it exists, every new of exactly so many bytes throws std::bad_alloc, in all threads. One at a time.
class FailingAllocation {
 public:
  explicit FailingAllocation(std::size_t bytes);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;
};

}  // namespace freevoxels::test
