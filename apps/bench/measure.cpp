#include "apps/bench/measure.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <thread>

namespace freevoxels::bench {

double least(int runs, const std::function<double()>& run) {
  // An idle GPU takes a while to reach its full clock rate.
  constexpr std::chrono::milliseconds kAtLeast(300);
  const auto start = std::chrono::steady_clock::now();
  double best = std::numeric_limits<double>::max();
  for (int i = 0; i < runs || std::chrono::steady_clock::now() - start < kAtLeast; ++i)
    best = std::min(best, run());
  return best;
}

double millisecondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double copyTime(std::uint64_t bytes) {
  std::vector<char> from(bytes, 1), to(bytes, 2);
  const std::size_t half = bytes / 2;
  return least(5, [&] {
    const auto start = std::chrono::steady_clock::now();
    std::thread other([&] { std::memcpy(to.data(), from.data(), half); });
    std::memcpy(to.data() + half, from.data() + half, bytes - half);
    other.join();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  });
}

}  // namespace freevoxels::bench
