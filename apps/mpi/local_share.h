#pragma once
// What a rank takes of the node that it shares with other ranks.

#include <algorithm>
#include <string>
#include <vector>

namespace freevoxels {

/// Threads of each of `ranks` processes on a node: their part of the processors that any of them may use, at least one and no more
/// than the process itself may use, which a launcher may have bound.
inline int threadsOfRank(int nodeProcessors, int ownProcessors, int ranks) {
  return std::clamp(nodeProcessors / ranks, 1, std::max(ownProcessors, 1));
}

/// The GPU of a process by its number on the node, in turn; empty where the node has none.
inline std::string gpuOfRank(const std::vector<std::string>& gpus, int rank) {
  return gpus.empty() ? "" : gpus[std::size_t(rank) % gpus.size()];
}

}  // namespace freevoxels
