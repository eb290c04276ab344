#pragma once
// Draws a frame by gathering: samples of a lattice on the image march through the slices of blocks across
// their major axis, a stencil restores the round footprint of classified voxels, and the sums are interpolated and averaged
// over pixels. The transmittance to the eye is computed along each sample's ray: Subr et al. 2007, Section 2.1,
// Eq. 4, without an attenuation table.

#include <functional>
#include <memory>
#include <span>

#include "engine/gathering/gather_frame.h"
#include "engine/gathering/gather_stages.h"
#include "engine/gathering/gather_volume.h"
#include "engine/scene/holdout.h"
#include "engine/splatting/splat_pass.h"

namespace freevoxels {

/// COMPUTE gather.comp, gather_roughness.comp, gather_refine.comp, gather_list_offsets.comp, gather_list.comp, gather_stencil.comp and
/// gather_resample.comp: premultiplied RGBA in `targets.colorEnergy` and the mean distance in `targets.distance`, if that exists. Leaves the
/// targets in layout GENERAL, visible to transfer.
class GatherPass {
 public:
  explicit GatherPass(const Device& device);
  /// Has the pipelines that march rays along the given axes compiled. The volume is prepared for the frame. `levels` says whether the frame
  /// has levels of detail above voxels, `holdout` whether it has one, `isProjected` whether scalars are projected.
  static void compileAhead(const Device& device, const GatherVolume& volume, const std::array<bool, 3>& axes, bool levels, bool holdout,
                           bool isProjected);
  /// Uploads the holdout of the next frames, if there is one and it is not that of the last frame. Returns its GatherFrame::holdout.
  glm::uvec2 holdOut(const std::shared_ptr<const Holdout>& holdout);
  void record(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame,
              const FrameTargets& targets);

  /// The steps of record(), for tests that alter what lies between them: begin() allocates the sums and writes the frame that the steps after it read.
  /// The targets have to be in layout GENERAL.
  void begin(Commands& commands, const shader::GatherFrame& frame);
  void recordSamples(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame);
  /// Marches samples in another way than that of one volume: every `samples.step`-th along both axes, `extent` of them, or with a step of 0
  /// those that are listed.
  using March = std::function<void(Commands&, glm::ivec2 extent, const shader::SamplesPush& samples)>;
  void recordSamples(Commands& commands, const shader::GatherFrame& frame, const March& march);
  enum class Case { Whole, Cube, Merged };
  /// Where a dispatch gets its frame and its size from.
  struct Dispatch {
    Case which = Case::Whole;
    const Buffer* frame;                ///< shader::GatherFrame
    glm::ivec2 threads{0};              ///< if it is not indirect
    const Buffer* arguments = nullptr;  ///< of an indirect dispatch
    std::uint64_t offset = 0;           ///< in `arguments`
    std::uint64_t mostGroups = 0;       ///< of an indirect dispatch
  };
  /// One dispatch for each axis along which the volume's rays march.
  void dispatch(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame, const Dispatch& how,
                const shader::SamplesPush& samples) const;
  /// The list of samples that are marched besides coarse ones: shader::SampleListHead and places.
  const Buffer& list() const { return adaptive_.list; }
  /// Of the last lattice.
  const TexelView& colorEnergyTexels() const { return gathered_.colorEnergyTexels; }
  const TexelView& distanceTexels() const { return gathered_.distanceTexels; }
  const Buffer& frameBuffer() const { return frame_; }
  /// Instead of all samples, marches those at these places of the lattice (x + y times its width), in this order; for tests.
  void recordListed(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame, std::span<const std::uint32_t> places);
  void recordStencil(Commands& commands, const shader::GatherFrame& frame);
  /// The sums of a volume that is on the device cube by cube: first recordClear, then recordCube for one after the other, in the order
  /// in which rays meet them, and with `frame.cube.isLast` for the last one. `frame.cube` is filled in. Then recordImage.
  void recordClear(Commands& commands, const shader::GatherFrame& frame);
  /// Sets what there is of an earlier frame's sums to 0, so that validation notices samples that are left out.
  void recordClear(Commands& commands);
  void recordCube(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame);
  /// The image in `targets`, as record() leaves it; `frame` is that of the whole volume.
  void recordImage(Commands& commands, const shader::GatherFrame& frame, bool scalars, const FrameTargets& targets);
  void recordResampling(Commands& commands, const shader::GatherFrame& frame, bool scalars, const FrameTargets& targets);
  /// The image of the gathered samples.
  void recordPixels(Commands& commands, const shader::GatherFrame& frame, bool scalars, const FrameTargets& targets);

  /// The lattice and the sums of the last frame; for validation and tests. The downloads wait.
  const GatherLattice& lattice() const { return lattice_; }
  std::vector<GatherSums> downloadGathered() const { return download(gathered_); }
  std::vector<GatherSums> downloadSmoothed() const { return download(smoothed_); }

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
  void dispatchSamples(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame, glm::ivec2 extent, Case which,
                       const shader::SamplesPush& samples = {.step = 1});
  std::vector<Binding> gatherBindings(const GatherVolume& volume, int axis, const Dispatch& how) const;
  std::vector<GatherSums> download(const Sums& sums) const;
  std::vector<Binding> sumBindings(const Sums& from, const Sums& to) const;

  const Device& device_;
  GatherLattice lattice_;  ///< of the last frame
  SampleRectangle seen_;   ///< of the last frame: outside of it sums are 0 and not stored
  Buffer frame_;  ///< shader::GatherFrame
  std::shared_ptr<const Holdout> heldOut_;
  Buffer holdoutDistances_;  ///< of `heldOut_`
  RenderTarget noDistance_;  ///< bound where a frame has none, of the format that the shader declares
  Buffer noLight_;           ///< and where it has no scattered light
  TexelView noLightTexels_;
  Sums gathered_, smoothed_, rows_;
  Adaptive adaptive_;
};

}  // namespace freevoxels
