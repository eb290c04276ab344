#pragma once
// Vectors of the values of all cells on the device, and the sweeps that map one to another. Only scattering_*.cpp include it.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/core/stages.h"
#include "engine/scene/lighting.h"
#include "engine/scene/sphere_quadrature.h"
#include "engine/volume/scattering_medium.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"
#include "shaders/scattering_interface.h"

namespace freevoxels {

/// Numbers of vectors: the solution, and from kBasis on those that GMRES keeps. All functions but the constructor's uploads wait for the
/// device.
class ScatteringGrid {
 public:
  static constexpr int kSolution = 0, kBasis = 1;

  /// Computes the direct light of all cells. The solution is 0. `medium` must outlive the grid.
  ScatteringGrid(const Device& device, const ScatteringMedium& medium, const Lighting& lighting);
  /// Bytes of device memory that the grids of a solution take at most while it is computed.
  static std::uint64_t bytes(const Device& device, glm::ivec3 dimensions, const glm::dmat4& indexToWorld, const Lighting& lighting);

  std::size_t cells() const { return count_; }
  /// Interpolates the solution from one on cells of twice the edge.
  void startFrom(const ScatteringGrid& coarse);
  /// to = what the solution becomes by being scattered once more, with all sources, less the solution.
  void sweepResidual(int to, const Progress& progress);
  /// to = from less what it becomes by being scattered once more, without sources.
  void sweepDifference(int from, int to, const Progress& progress);
  /// Makes the solution that of this number of orders. Returns the number of sets of sweeps.
  int sweepOrders(int orders, const Progress& progress);
  /// The scalar products of a vector with `count` vectors from `first` on.
  std::vector<double> dots(int vector, int first, int count);
  /// to = scale * (from + sum of factors * the vectors from `first` on)
  struct Combination {
    int to, from;
    int first = 0;
    std::vector<double> factors = {};
    double scale = 1.0;
  };
  void combine(const Combination& combination);
  /// vec4 by cell and moment.
  Buffer makeTexels();

 private:
  /// What a set of sweeps does: to = ofFrom * from + ofSum * (the light of all directions).
  struct Sweep {
    int scattered;  ///< the vector that is scattered; -1 for none
    bool direct, emission, sky;
    int from, to;
    float ofFrom, ofSum;
  };
  Buffer uploadDirectExtinctions() const;
  void makeDirect(const Lighting& lighting);
  void sweep(const Sweep& sweep, const Progress& progress);
  int planes() const { return channels_ * moments_; }
  int vectorLength() const { return planes() * int(count_); }
  Specialisation constants() const { return {std::uint32_t(channels_), moments_ > 1}; }
  Specialisation sweepConstants() const { return {std::uint32_t(channels_), moments_ > 1, tinted_}; }
  Specialisation directConstants(bool rayTexels, bool atInfinity) const {
    return {std::uint32_t(channels_), rayTexels, moments_ > 1, atInfinity};
  }
  void compileAhead() const;

  const Device& device_;
  const ScatteringMedium& medium_;
  std::vector<QuadratureDirection> directions_;
  const std::size_t count_;
  int channels_, moments_;
  int batch_ = 1;        ///< directions that are swept at once
  double flux_ = 0.0;    ///< 3 g
  bool tinted_ = false;  ///< whether each channel has its own extinction
  bool hasSky_ = false, emits_ = false, lit_ = false;
  glm::dvec3 depthScale_{1.0};  ///< factor of optical depths towards lights
  Buffer mediumPlanes_, direct_, vectors_, sweepDirections_, sums_;
  Buffer sources_;  ///< vec4 by moment and cell
  Buffer light_;    ///< by direction of the batch, channel and cell
  TexelView mediumTexels_, directTexels_, vectorTexels_, sourceTexels_, lightTexels_;
};

}  // namespace freevoxels
