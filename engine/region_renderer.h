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

#include "engine/frame_renderer.h"
#include "engine/storage/baked_volume.h"
#include "engine/volume/classification.h"

namespace freevoxels {

class RegionRenderer : public ShareRenderer {
 public:
  /// Why frames of a file cannot be drawn region by region, as a clause; nothing if they can. They are drawn by splats with look-ups
  /// in the table of 26 directions: an eye or lights inside the volume's box, exact transmittance, the Sorted composite and what the
  /// file has no regions for need the whole volume at once.
  static std::optional<std::string> whyNot(const fvx::FvxFile& file, const Classification& classification, const TableSettings& table,
                                           const std::vector<Camera>& cameras, const FrameSettings& settings);

  /// `keepsRegions`: whether regions stay on the device for further frames, as far as there is room.
  RegionRenderer(const Device& device, std::shared_ptr<const fvx::FvxFile> file, const Classification& classification,
                 const TableSettings& table, bool keepsRegions);
  ~RegionRenderer() override;

  /// Draws the regions of a part of the shares, of which each region belongs to one (shareOf its place among the level's). The bits of
  /// the sums do not depend on the memory either. Reads regions that are drawn and no others. Fails with ErrorKind::OutOfMemory where
  /// one region does not fit.
  FixedSums renderShares(const Camera& camera, const FrameSettings& settings, const SharePart& part,
                         const Progress& progress = {}) override;
  /// The image of all shares.
  Image render(const Camera& camera, const FrameSettings& settings, const Progress& progress = {}) override;

  std::vector<StageTime> timings() const override;
  VolumeMemory memory() const override;
  /// Regions that the last frame drew, by level; and how many of them were read for it.
  struct Counts {
    std::vector<std::size_t> drawn;
    std::size_t read = 0;
  };
  Counts counts() const;

 private:
  friend std::vector<std::vector<std::uint8_t>> downloadTable(RegionRenderer& renderer, const fvx::RegionEntry& region);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace freevoxels
