#pragma once
// The processes of an MPI job as a ShareGroup, and what each of them sets up before it draws.

#include <mpi.h>

#include <optional>

#include "apps/common/share_group.h"

namespace freevoxels {

class MpiJob : public ShareGroup {
 public:
  /// Initialises MPI, and divides the node's processors among the job's processes on this node: lavapipe and TBB start no more threads
  /// than this process has. To be called before any Vulkan instance exists.
  MpiJob(int& argc, char**& argv);
  /// Finalises MPI.
  ~MpiJob() override;
  MpiJob(const MpiJob&) = delete;
  MpiJob& operator=(const MpiJob&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Ends all processes of the job with this exit code.
  [[noreturn]] void abort(int exitCode) const;
  /// "rank 2 on node7"
  std::string name() const;

  /// Fails where the launcher started processes that do not know each other, or more than there are shares.
  void begin() override;
  /// Frame f is drawn by group f modulo the number of groups.
  void splitFrames(int ranksPerFrame) override;
  bool leads() const override { return rank_ == 0; }
  std::string deviceSelector() const override;
  void agree(const std::string& what, const std::string& text) override { agreeWithin(MPI_COMM_WORLD, what, text); }
  std::uint64_t least(std::uint64_t value) override;
  bool draws(std::size_t frame) const override { return int(frame % std::size_t(groupCount_)) == group_; }
  SharePart part() const override { return {rankInGroup_, sizeOfGroup_}; }
  bool addUp(FixedSums& sums) override;
  SharePart place() const override { return {rank_, size_}; }
  void bring(std::vector<std::byte>& bytes, int from) override;
  void logStages(const RunReport& report) override;

 private:
  void shareProcessors() const;
  void agreeWithin(MPI_Comm processes, const std::string& what, const std::string& text) const;

  int rank_ = 0, size_ = 1;
  int threads_ = MPI_THREAD_SINGLE;  ///< how threads may call MPI
  MPI_Comm node_ = MPI_COMM_NULL;  ///< the processes on this node
  int rankOnNode_ = 0, sizeOfNode_ = 1;
  MPI_Comm frameGroup_ = MPI_COMM_NULL;  ///< the processes that draw a frame together
  int group_ = 0, groupCount_ = 1, rankInGroup_ = 0, sizeOfGroup_ = 1;
};

}  // namespace freevoxels
