#pragma once
// The processes that draw the frames of one run together: each draws shares of it (engine/splatting/shares.h), and their
// fixed-point sums are added up. Implemented by apps/mpi; a run without a group is drawn by one process alone.

#include <cstddef>
#include <string>
#include <vector>

#include "apps/common/timings_file.h"
#include "engine/image/fixed_sums.h"
#include "engine/splatting/shares.h"

namespace freevoxels {

class ShareGroup {
 public:
  virtual ~ShareGroup() = default;

  /// Before any work: fails (ErrorKind::Usage) where the processes cannot work together.
  virtual void begin() = 0;
  /// Divides the processes into groups of so many, which draw frames side by side. Fails (ErrorKind::Usage) where there are fewer.
  virtual void splitFrames(int processesPerFrame) = 0;
  /// Whether this process is the one that prints, shows progress and writes what belongs to the run as a whole.
  virtual bool leads() const = 0;
  /// A device for this process, as for --device; empty: the one that every process would choose.
  virtual std::string deviceSelector() const = 0;
  /// Fails (ErrorKind::Input) on a process whose `text` differs from that of the leading process; `what` completes "rank 2 has ...".
  virtual void agree(const std::string& what, const std::string& text) = 0;
  /// The least of the values of all processes, on all of them.
  virtual std::uint64_t least(std::uint64_t value) = 0;
  /// Whether this process draws a part of the frame.
  virtual bool draws(std::size_t frame) const = 0;
  /// The shares that this process draws of such a frame.
  virtual SharePart part() const = 0;
  /// Adds up the sums of all processes that draw the frame. True on the one that has the total afterwards. May be called by another
  /// thread, but not while any other function is called.
  virtual bool addUp(FixedSums& sums) = 0;
  /// This process among all processes, and their number.
  virtual SharePart place() const = 0;
  /// Moves the bytes from process `from` to the leading one; to be called by these two.
  virtual void bring(std::vector<std::byte>& bytes, int from) = 0;
  /// Prints the least, mean and most time of each stage over all processes, with --verbose. All of them must call it.
  virtual void logStages(const RunReport& report) = 0;
};

}  // namespace freevoxels
