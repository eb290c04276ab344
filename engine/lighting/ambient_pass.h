#pragma once
// Light from everywhere for the gather: what of it reaches cells of a volume, by sweeps along the 26 directions of Subr et
// al. 2007, Section 3.1, that add up light in place of keeping depths.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/scene/directions.h"
#include "engine/scene/lighting.h"
#include "engine/scene/source_rays.h"
#include "engine/volume/classification.h"
#include "engine/vulkan/commands.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

/// Ambient light is smooth: a volume has no more cells than these, which are cubes of voxels with a power of two of them
/// along an edge. With a phase function every view has sweeps of its own, of fewer cells.
inline constexpr std::uint64_t kMostAmbientCells = 4u << 20, kMostPhaseCells = 1u << 19;
int ambientCellEdge(glm::ivec3 dimensions, bool hasPhase);

/// The mean extinction, per world unit, of the voxels of each cell, x fastest; what of a cell is beyond the volume is empty.
std::vector<float> cellExtinctions(const Volume& volume, const Classification& classification, int edge);

/// COMPUTE ambient_sweep.comp: a dispatch a direction. Belongs to one volume.
class AmbientPass {
 public:
  /// Looks at all voxels; `edge` is that of the cells. Fails with ExitCode::OutOfMemory.
  AmbientPass(const Device& device, const Volume& volume, const Classification& classification, int edge);

  /// Uniform light without a tint is one channel, else each colour is one.
  static int channelCount(const Lighting& lighting);
  /// Records the sweeps for light that differs from that of the call before, or with a phase function for another eye (index
  /// space); whether it did. `lighting` comes from everywhere.
  bool record(Commands& commands, const Lighting& lighting, const RaySource& eye);
  /// Radiance, of all octaves of scattering, that light() is parts of: the mean over all directions where nothing is in the
  /// way; with a phase function, which may weight any direction most, that of the brightest one.
  glm::dvec3 unshadowed() const { return unshadowed_; }

  /// Of each cell and channel, what part of the unshadowed light reaches it. float, cells of a channel after each other; with a
  /// phase function then the weights to divide it by.
  const Buffer& light() const { return light_; }
  bool hasWeights() const { return like_.phaseG != 0.0; }
  glm::ivec3 cells() const { return cells_; }
  int edge() const { return edge_; }

 private:
  const Device& device_;
  glm::dmat4 indexToWorld_;
  int edge_;
  glm::ivec3 cells_;
  Buffer extinction_;  ///< cellExtinctions()
  Buffer light_;
  Pipeline pipeline_;
  std::vector<glm::dvec3> parts_;  ///< of the unshadowed light, by direction: what `light_` was made of
  Lighting like_;                  ///< its tint, phase function and octaves of scattering
  RaySource eye_;                  ///< that it was weighted for
  glm::dvec3 unshadowed_{0.0};
};

}  // namespace freevoxels
