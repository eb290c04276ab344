#pragma once
// Ambient light for the gather: how much of it reaches cells of a volume, by sweeps along the 26 directions
// of Subr et al. 2007, Section 3.1, that add up light instead of storing optical depths.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/scene/directions.h"
#include "engine/scene/lighting.h"
#include "engine/scene/source_rays.h"
#include "engine/volume/classification.h"
#include "engine/vulkan/commands.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

/// Largest numbers of cells, without and with a phase function. Ambient light is smooth, so that cells may be
/// cubes of 2, 4, ... voxels along an edge. With a phase function every view has its own sweeps, which have
/// fewer cells.
inline constexpr std::uint64_t kMaxAmbientCells = 1u << 20, kMaxPhaseCells = 1u << 19;
int ambientCellEdge(glm::ivec3 dimensions, bool hasPhase);

/// COMPUTE ambient_sweep.comp: a dispatch for each direction. Belongs to one volume.
class AmbientPass {
 public:
  /// Reads all voxels on the host. `edge` is the number of voxels along a cell's edge. Fails with
  /// ErrorKind::OutOfMemory.
  AmbientPass(const Device& device, const Volume& volume, const Classification& classification, int edge);
  /// For a volume whose cellExtinctions() are given.
  AmbientPass(const Device& device, glm::ivec3 dimensions, const glm::dmat4& indexToWorld, int edge, std::span<const float> extinctions);

  /// One channel for uniform light without a tint, otherwise one for each colour.
  static int channelCount(const Lighting& lighting);
  /// Records the sweeps if the light differs from that of the last call, or with a phase function if the eye
  /// (in index space) does. Returns whether it did. `lighting` must have ambient light.
  bool record(Commands& commands, const Lighting& lighting, const RaySource& eye);
  /// The radiance, of all octaves of scattering, that light() holds fractions of: the unshadowed mean over
  /// all directions, or with a phase function, which may weight any direction most, that of the brightest
  /// direction.
  glm::dvec3 unshadowed() const { return unshadowed_; }

  /// float: the fraction of the unshadowed light that reaches each cell, channel by channel; with a phase
  /// function followed by the weights to divide by.
  const TexelView& light() const { return lightTexels_; }
  bool hasWeights() const { return like_.phaseG != 0.0; }
  glm::ivec3 cells() const { return cells_; }
  int edge() const { return edge_; }

 private:
  const Device& device_;
  glm::dmat4 indexToWorld_;
  int edge_;
  glm::ivec3 cells_;
  Buffer extinction_;  ///< float: cellExtinctions()
  Buffer light_;
  TexelView extinctionTexels_, lightTexels_;
  Pipeline pipeline_;
  std::vector<glm::dvec3> parts_;  ///< the unshadowed light by direction from which `light_` was made
  Lighting like_;                  ///< the tint, phase function and octaves from which `light_` was made
  RaySource eye_;                  ///< the eye for which `light_` was weighted
  glm::dvec3 unshadowed_{0.0};
};

}  // namespace freevoxels
