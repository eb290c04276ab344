#pragma once
// Draws several volumes in one image by gathering, whatever their order. Each marches the rays of one lattice by itself; what it has along
// a ray is added up in slabs between planes parallel to the image, about twice as thick as the smallest voxels there. Within a slab the
// media are mixed: extinctions, and the light that they scatter and emit, add up (engine/docs/gather.md, "Several volumes"). Rays that meet
// one volume only are those of its own frame.

#include <algorithm>
#include <span>
#include <vector>

#include "engine/gathering/gather_pass.h"

namespace freevoxels {

/// The slabs of a frame.
struct SlabPlan {
  std::vector<shader::SlabInterval> intervals;
  int slabs = 0;
};

/// A volume between two distances from the eye plane, with slabs of this thickness where it is.
struct SlabExtent {
  double begin = 0.0, end = 0.0, thickness = 1.0;
};
/// Covers all extents, with the thinnest of their slabs where they overlap; thicker ones if there would be more than `most`. At most
/// shader::kMaxMerged extents.
SlabPlan planSlabs(std::span<const SlabExtent> extents, int most = shader::kMaxSlabs);

/// COMPUTE merge_rays.comp and gather.comp, for one range of rays after the other.
class MergedPass {
 public:
  /// One of the volumes, prepared for the frame; all frames have the same lattice (shareLattice). At most shader::kMaxMerged.
  struct Part {
    const GatherVolume* volume;
    const DeviceVolume* onDevice;
    shader::GatherFrame frame;
  };

  explicit MergedPass(const Device& device) : device_(device), pass_(device) {}
  /// The image in `targets`, as GatherPass::record leaves it.
  void record(Commands& commands, std::span<const Part> parts, const Camera& camera, const FrameTargets& targets);
  /// The sums of the samples alone.
  void recordSamples(Commands& commands, std::span<const Part> parts, const Camera& camera);
  GatherPass& pass() { return pass_; }

 private:
  void begin(Commands& commands, std::span<const Part> parts, const Camera& camera);
  void march(Commands& commands, std::span<const Part> parts, glm::ivec2 extent, const shader::SamplesPush& samples);
  void marchBand(Commands& commands, std::span<const Part> parts, GatherPass::Dispatch target, const shader::SamplesPush& samples);
  std::uint64_t mostEntries() const;
  /// The number of volumes that may store lists, at least 1.
  int listedVolumes() const { return std::max(volumes_ - 1, 1); }
  int mostSlabs(const shader::GatherFrame& frame) const;
  std::uint64_t entriesOfSlot() const;
  int rowsOfBand(int columns, int rows, bool listed) const;
  void makeRoom(const shader::GatherFrame& frame);
  void makeRoom(std::uint64_t slots);

  const Device& device_;
  GatherPass pass_;
  std::vector<Buffer> frames_;  ///< shader::GatherFrame of each part
  Buffer merge_;                ///< shader::MergeFrame
  Buffer rays_, counts_;        ///< uint by slot: volumes that are met; by volume but the last and slot: numbers of entries
  Buffer entries_, depths_;  ///< vec4 by volume but the last, number and slot; `depths_` only where light has another extinction than alpha
  TexelView entryTexels_, depthTexels_;
  int volumes_ = 0, slabs_ = 0;
  bool mayOverlap_ = false;  ///< whether some rays may meet several of the volumes
  bool tinted_ = false;
};

}  // namespace freevoxels
