#pragma once
// Draws a frame by gathering: samples of a lattice on the image march through the slices of blocks across
// their major axis, a stencil restores the round footprint of classified voxels, and the sums are interpolated and averaged
// over pixels. The transmittance to the eye is computed along each sample's ray: Subr et al. 2007, Section 2.1,
// Eq. 4, without an attenuation table.

#include <functional>
#include <memory>
#include <vector>

#include "engine/gathering/gather_frame.h"
#include "engine/gathering/gather_image.h"
#include "engine/gathering/gather_stages.h"
#include "engine/gathering/gather_volume.h"
#include "engine/scene/holdout.h"
#include "engine/splatting/frame_targets.h"

namespace freevoxels {

/// COMPUTE gather.comp, gather_roughness.comp, gather_refine.comp, gather_list_offsets.comp, gather_list.comp and gather_stencil.comp, and
/// GatherTiles and GatherImage: premultiplied RGBA in `targets.colorEnergy` and the mean distance in `targets.distance`, if that exists.
/// Leaves the targets in layout GENERAL, visible to later commands.
class GatherPass {
 public:
  explicit GatherPass(const Device& device);
  /// What a frame's rays march besides the voxels: levels of detail above them; up to a holdout; with a projection of scalars; in a part of
  /// the volume alone (RayClip); in quarters of the way between two slices.
  struct Rays {
    bool levels = false, holdout = false, areProjected = false, clips = false, quarters = false;

    explicit Rays(const shader::GatherFrame& frame)
        : levels(frame.coarsest > 0),
          holdout(frame.raysOfPixel > 0),
          areProjected(frame.projection != 0),
          clips(frame.clips != 0),
          quarters(frame.quarters > 0.0f) {}
  };
  /// Compiles the pipelines that march rays along the given axes. The volume is prepared for the frame.
  static void compileAhead(const Device& device, const GatherVolume& volume, const std::array<bool, 3>& axes, Rays rays);
  /// Uploads the holdout of the next frames, unless it is null or that of the last frame. Returns its address for GatherFrame::holdout.
  glm::uvec2 holdOut(const std::shared_ptr<const Holdout>& holdout);
  /// Records all steps of a frame of one volume.
  void record(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame,
              const FrameTargets& targets);

  // The steps of record(), for parts of a frame and for tests that alter what lies between them.

  /// Allocates the sums, and writes the frame that the steps after it read.
  void begin(Commands& commands, const shader::GatherFrame& frame);
  void recordSamples(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame);
  /// Marches samples in another way than that of one volume: every `samples.step`-th along both axes, `extent` of them, or with a step of 0
  /// those that are listed.
  using March = std::function<void(Commands&, glm::ivec2 extent, const shader::SamplesPush& samples)>;
  void recordSamples(Commands& commands, const shader::GatherFrame& frame, const March& march);
  /// What a dispatch marches: a whole volume, a cube of it, or one of several volumes in the same place.
  enum class Variant { Whole, Cube, Merged };
  /// Where a dispatch gets its frame and its size from.
  struct Dispatch {
    Variant variant = Variant::Whole;
    const Buffer* frame = nullptr;      ///< shader::GatherFrame
    glm::ivec2 threads{0};              ///< if it is not indirect
    const Buffer* arguments = nullptr;  ///< of an indirect dispatch
    std::uint64_t offset = 0;           ///< in `arguments`
    std::uint64_t mostGroups = 0;       ///< of an indirect dispatch
    const TexelView* slabs = nullptr;   ///< with Variant::Merged: entries of the lists of volumes
    const TexelView* depths = nullptr;  ///< and their optical depths for light; null where that has no other extinction than alpha
    int lists = 0;                      ///< and how many of these are composited with the volume; 0 if it stores a list itself
  };
  /// One dispatch for each axis along which the volume's rays march.
  void dispatch(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame, const Dispatch& target,
                const shader::SamplesPush& samples) const;
  /// The list of samples that are marched besides coarse ones: shader::SampleListHead and places.
  const Buffer& list() const { return adaptive_.list; }
  /// Texels of the sums of the last frame's samples.
  const TexelView& colorEnergyTexels() const { return gathered_.colorEnergyTexels; }
  const TexelView& distanceTexels() const { return gathered_.distanceTexels; }
  const Buffer& frameBuffer() const { return frame_; }
  /// Of the tiles that the image is drawn of.
  void recordStencil(Commands& commands, const shader::GatherFrame& frame);

  // A volume that is on the device cube by cube: first recordClear, then recordCube for one after the other, in the order in which rays
  // meet them, and with `frame.cube.isLast` for the last one. `frame.cube` is filled in. Then recordImage.

  /// Allocates the sums, and sets them to 0.
  void recordClear(Commands& commands, const shader::GatherFrame& frame);
  void recordCube(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame);
  /// The image in `targets`, as record() leaves it; `frame` is that of the whole volume.
  void recordImage(Commands& commands, const shader::GatherFrame& frame, bool scalars, const FrameTargets& targets);
  void recordResampling(Commands& commands, const shader::GatherFrame& frame, bool scalars, const FrameTargets& targets);
  /// The image of the gathered samples.
  void recordPixels(Commands& commands, const shader::GatherFrame& frame, bool scalars, const FrameTargets& targets);

  /// The sums of some rows of the last frame's lattice, x fastest. Waits.
  std::vector<GatherSums> downloadRows(glm::ivec2 rows) const { return download(gathered_, rows); }
  /// The lattice of the last frame, and its sums before and after the stencil; for validation and tests. The downloads wait.
  const GatherLattice& lattice() const { return lattice_; }
  std::vector<GatherSums> downloadGathered() const { return download(gathered_, {0, lattice_.samples.y}); }
  std::vector<GatherSums> downloadSmoothed() const;

 private:
  /// C and E (four floats), and the sum of e times distance, of every sample.
  struct Sums {
    Buffer colorEnergy, distances;
    TexelView colorEnergyTexels, distanceTexels;
  };
  /// The coarse samples' roughness, and the list of the samples to be marched besides them.
  struct Adaptive {
    Buffer roughness, list, groupCounts;
    TexelView roughnessTexels;
  };
  void setLattice(const shader::GatherFrame& frame);
  void makeAdaptiveRoom(std::uint64_t coarse, std::uint64_t groups);
  void recordAdaptive(Commands& commands, const shader::GatherFrame& frame, const March& march);
  shader::SamplesPush recordList(Commands& commands, glm::ivec2 coarse, glm::ivec2 groups);
  void makeRoom(Sums& sums, std::uint64_t samples);
  /// `extent` is that of the samples that are dispatched, unless they are listed.
  void dispatchSamples(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame, glm::ivec2 extent, Variant variant,
                       const shader::SamplesPush& samples = {.step = 1});
  std::vector<Binding> gatherBindings(const GatherVolume& volume, int axis, const Dispatch& target) const;
  std::vector<GatherSums> download(const Sums& sums, glm::ivec2 rows) const;
  std::vector<Binding> sumBindings(const Sums& from, const Sums& to) const;

  const Device& device_;
  GatherLattice lattice_;  ///< of the last frame
  SampleRectangle seen_;   ///< of the last frame: outside of it sums are 0 and not stored
  Buffer frame_;  ///< shader::GatherFrame
  std::shared_ptr<const Holdout> heldOut_;
  Buffer holdoutDistances_;  ///< of `heldOut_`
  Buffer noLight_;           ///< bound where a frame has no scattered light
  TexelView noLightTexels_;
  Sums gathered_, smoothed_;
  GatherTiles tiles_;
  GatherImage image_;
  Adaptive adaptive_;
};

}  // namespace freevoxels
