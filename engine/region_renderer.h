#pragma once
// Draws a baked volume region by region (storage/regions.h), so that the volume fits neither into the device's memory nor into the
// host's: Subr et al. 2007, Sections 3.1, 4.4 and 5.
//
// A region's attenuation table is swept from its own extinction and from the optical depths where lines enter it; its splats are
// added to the sums of its share in float targets, and these to 64-bit fixed-point sums. What is added to what does not depend on the
// memory, and the image therefore has the same bits with any memory that holds one region.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/stages.h"
#include "engine/image/fixed_sums.h"
#include "engine/image/image.h"
#include "engine/memory_planner.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/splatting/shares.h"
#include "engine/storage/baked_volume.h"
#include "engine/visibility/cut_pass.h"
#include "engine/volume/classification.h"

namespace freevoxels {

class RegionRenderer {
 public:
  /// Why frames of a file cannot be drawn region by region, as a clause; nothing if they can. They are drawn by splats with look-ups
  /// in the table of 26 directions: an eye or lights inside the volume's box, exact transmittance, the Sorted composite and what the
  /// file has no regions for need the whole volume at once.
  static std::optional<std::string> whyNot(const fvx::FvxFile& file, const Classification& classification, const TableSettings& table,
                                           const std::vector<Camera>& cameras, const FrameSettings& settings);

  /// `keepsRegions`: whether regions stay on the device for further frames, as far as there is room.
  RegionRenderer(const Device& device, std::shared_ptr<const fvx::FvxFile> file, const Classification& classification,
                 const TableSettings& table, bool keepsRegions);
  ~RegionRenderer();

  /// Draws the regions of a part of the shares, of which each region belongs to one (shareOf its place among the level's). The sums
  /// of all parts add up to the same bits, however many parts there are and however much memory, on devices of one kind. Reads
  /// regions that are drawn and no others. Fails with ErrorKind::OutOfMemory where one region does not fit.
  FixedSums renderShares(const Camera& camera, const FrameSettings& settings, const SharePart& part, const Progress& progress = {});
  /// The image of all shares.
  Image render(const Camera& camera, const FrameSettings& settings, const Progress& progress = {});

  /// Stage times of the last frame, in order.
  std::vector<StageTime> timings() const;
  /// Regions that the last frame drew, by level; and how many of them were read for it.
  struct Counts {
    std::vector<std::size_t> drawn;
    std::size_t read = 0;
  };
  Counts counts() const;

  // As of Renderer: what is known without the whole volume.
  VolumeMemory memory() const;  ///< of the largest region
  std::optional<std::uint64_t> occupiedVoxelCount() const { return {}; }
  CutCounts cutCounts() const { return {}; }
  bool lackedRoomForRays() const { return false; }
  bool lackedRoomForGather() const { return false; }

 private:
  friend std::vector<std::vector<std::uint8_t>> downloadTable(RegionRenderer& renderer, const fvx::RegionEntry& region);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace freevoxels
