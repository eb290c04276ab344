#pragma once
// The sweeps of the attenuation table (Subr et al. 2007, Section 3.1, Eq. 5) through a level that need not fit into memory. Only what
// regions have beside their voxels is kept (regions.h): the depths where lattice lines enter them, and their halos.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/spool.h"
#include "engine/storage/regions.h"

namespace freevoxels::fvx {

/// Number of planes that a sweep reads at once: those of a layer of bricks.
inline constexpr int kSweptPlanes = ScalarBricks::kEdge;

/// Writes the densities of all voxels of planes `first` to `first` + kSweptPlanes - 1, as far as the level has them, x fastest; 0 where
/// there is none. `first` is a multiple of kSweptPlanes.
using PlaneSource = std::function<void(int first, std::span<float> densities)>;

struct SweptLevel {
  glm::ivec3 dimensions{0};
  glm::dmat4 indexToWorld{1.0};     ///< of the level's voxels; steps have their own lengths (path-length correction)
  std::vector<glm::ivec3> regions;  ///< that are wanted
  PlaneSource planes;
  double densityScale = 1.0;  ///< extinction per world unit at density 1
  Encoding encoding;          ///< of densities
};

/// What a level's regions have beside their voxels, in a temporary file.
class SweptRegions {
 public:
  explicit SweptRegions(const std::filesystem::path& folder) : spool_(folder) {}

  /// Sweeps a level in 26 directions. Memory: a layer of bricks, a plane of depths for each direction that is swept at once, and the
  /// faces of two layers of regions.
  void sweep(const SweptLevel& level, const std::function<void(double fraction)>& progress = {});

  /// Which parts `regions[region]` has (RegionEntry::parts): those of which some value is not 0.
  std::uint64_t parts(std::size_t region) const;
  /// Their bytes, as regionBytes counts them.
  std::vector<std::byte> bytes(std::size_t region) const;

 private:
  friend class LevelSweep;
  struct Part {
    std::uint64_t offset = 0, bytes = 0;  ///< 0 bytes: not stored
  };
  Spool spool_;
  std::vector<std::array<Part, kEntryFaces + 1>> parts_;  ///< by region; the last is the halo
};

}  // namespace freevoxels::fvx
