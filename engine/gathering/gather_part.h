#pragma once
// A frame that is gathered part by part: the bricks of a part are marched, with the transmittance in front of each from the eye's rays, and
// their sums are added in fixed point. Those of all parts add up to the same bits, however the bricks are divided: Subr et al. 2007,
// Section 4.4, for the samples of a lattice instead of splats.

#include <cstdint>
#include <optional>

#include "engine/attenuation/ray_sweep.h"
#include "engine/gathering/gather_pass.h"
#include "engine/image/fixed_sums.h"
#include "engine/splatting/shares.h"

namespace freevoxels {

/// What has to be marched of a volume for a part: as GatherVolume has it for all of it.
struct PartCells {
  std::vector<std::uint32_t> numbers;  ///< of the bricks; those of the part have shader::kOwnBrick
  std::vector<std::uint8_t> skips;     ///< groups of slices to skip; what other parts have is skipped as if it were empty
};

/// Chunks of bricks are dealt to the shares level by level along the Hilbert curve. The chunks depend on the volume only, not on the part.
PartCells partCells(const GatherVolume::BrickCells& cells, const std::vector<shader::GatherLevel>& levels, const SharePart& part);

/// The sums of the samples of a frame's lattice that are seen, without values. `layout` describes those of pixels of the frame.
FixedSums partSums(const shader::GatherFrame& frame, bool scalars, FixedSums layout);

/// COMPUTE ray_sweep.comp for the eye, then gather.comp. Belongs to one volume.
class GatherPartPass {
 public:
  explicit GatherPartPass(const Device& device);

  /// Records the sums of a part of a frame whose volume is prepared. `frame` is that of the whole image; `layout` describes the sums of
  /// pixels of such a frame, of which those of samples take the digits. Fails with ErrorKind::OutOfMemory.
  void record(Commands& commands, GatherPass& gather, const GatherVolume& volume, const DeviceVolume& onDevice,
              const shader::GatherFrame& frame, const RaySource& eye, const SharePart& part, FixedSums layout);
  /// After the recorded commands are complete. Blocks until the copy is complete.
  FixedSums read() const;

 private:
  void choose(const GatherVolume& volume, const SharePart& part);
  void makeRoom();

  const Device& device_;
  RaySweep rays_;
  std::optional<SharePart> part_;   ///< that the buffers of cells were made for
  Buffer numbers_, skips_;
  TexelView numberTexels_, skipTexels_;
  FixedSums layout_;
  Buffer sums_;      ///< int64 [channel][sample of the rectangle]
  Buffer overflow_;  ///< uint
};

}  // namespace freevoxels
