#include "tests/failing_allocation.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> failing{0};  // bytes; 0 for none

}  // namespace

void* operator new(std::size_t bytes) {
  const std::size_t wanted = failing.load(std::memory_order_relaxed);
  if (wanted == 0 || bytes != wanted)
    if (void* const memory = std::malloc(bytes > 0 ? bytes : 1)) return memory;
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace freevoxels::test {

FailingAllocation::FailingAllocation(std::size_t bytes) {
  failing = bytes;
}

FailingAllocation::~FailingAllocation() {
  failing = 0;
}

}  // namespace freevoxels::test
