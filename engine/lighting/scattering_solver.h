#pragma once
// Light that is scattered any number of times: the equation of radiative transfer, solved on cells of a volume by the sweeps of Subr et al.
// 2007, Section 3.1, along 26 directions that add up light instead of optical depths. See engine/docs/method.md.

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "engine/core/stages.h"
#include "engine/scene/lighting.h"
#include "engine/scene/scattered_field.h"
#include "engine/volume/scattering_medium.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"
#include "shaders/frame_interface.h"
#include "shaders/scattering_interface.h"

namespace freevoxels {

class ScatteringGrid;

/// Iterations end when the equation's residual is at most this fraction of the light that is scattered once more.
inline constexpr double kScatteringTolerance = 3e-3;

/// COMPUTE scattering_*.comp. Belongs to one medium.
///
/// The unknowns are, for each cell, the mean J over all directions of the radiance of light that was scattered at least once, comes from
/// the surroundings or is emitted; and with a phase function its flux. A set of 26 sweeps maps them to what they become by being scattered
/// once more; the fixed point of that linear map is found by GMRES (Saad and Schultz 1986), which starts from the solution on cells of
/// twice the edge. The result does not depend on lights of earlier calls.
class ScatteringSolver {
 public:
  ScatteringSolver(const Device& device, ScatteringMedium medium);
  /// Of a part of its medium, on cells whose edge is `coarseness` times doubled, for drafts.
  ScatteringSolver clipped(const RayClip& clip, int coarseness) const;

  /// Solves for this light, on cells whose edge is `coarseness` times doubled, unless that was done by the last call; blocks. The light's
  /// attenuation does not matter. Fails with ErrorKind::OutOfMemory; after an exception nothing is solved.
  void solve(const Lighting& lighting, int coarseness, std::vector<StageTime>& times, const Progress& progress);
  /// Changes with each solution.
  std::uint64_t version() const { return version_; }
  /// Whether the last solve() was completed.
  bool isSolved() const { return solved_.has_value(); }

  /// vec4: J of each cell, with a phase function followed by the flux along x, y and z (rgb).
  const TexelView& texels() const { return texels_; }
  /// For look-ups at positions in an index space, which `toMedium` takes to that of the medium.
  shader::ScatteredGrid onDevice(const glm::dmat4& toMedium = glm::dmat4(1.0)) const;
  /// In the cells of the last solution.
  const ScatteringMedium& medium() const { return media_[level_]; }
  /// deltaScaleOf() the light.
  const glm::dvec3& deltaScale() const { return deltaScale_; }
  /// The solution on the host. Waits.
  ScatteredField download() const;
  /// No point scatters more of this light than this radiance, for albedo 1.
  double brightest() const { return brightest_; }
  /// How the last solution was found.
  const ScatteringFacts& facts() const { return facts_; }

 private:
  std::unique_ptr<ScatteringGrid> solveOrders(const Lighting& lighting, const Progress& progress);
  std::unique_ptr<ScatteringGrid> solveAllOrders(const Lighting& lighting, const Progress& progress);

  const Device& device_;
  std::vector<ScatteringMedium> media_;  ///< the medium, and the same in cells of twice the edge, again and again
  std::optional<Lighting> solved_;
  std::size_t level_ = 0;  ///< number of the medium on which it was solved
  std::uint64_t version_ = 0;
  bool isDraft_ = false;  ///< whether all solutions are those of drafts
  ScatteringFacts facts_;
  double brightest_ = 0.0;
  glm::dvec3 deltaScale_{1.0};
  Buffer texelBuffer_;
  TexelView texels_;
};

/// Whether light reaches the volume's medium that ScatteringSolver finds: from the surroundings, from other parts of the medium, or
/// emitted.
bool hasScatteredLight(const Lighting& lighting, bool emits);
/// Bytes of device memory that a solution takes at most while it is computed.
std::uint64_t scatteringBytes(const Device& device, const Volume& outline, const Lighting& lighting);

}  // namespace freevoxels
