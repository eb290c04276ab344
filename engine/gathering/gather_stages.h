#pragma once
// What the stages of a gathered frame make, on the host: for validation and tests, which compare each stage of the device
// with a reference that is given what the stage before it made.

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine/image/image.h"
#include "engine/octree/level_data.h"
#include "engine/scene/scattered_field.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

class GatherPass;
class GatherVolume;
struct BuiltVolume;

/// The samples of a frame: a regular lattice on the image.
struct GatherLattice {
  glm::ivec2 samples{0};
  double pitch = 1.0;      ///< pixels between neighbouring samples
  glm::dvec2 first{0.0};   ///< position of sample (0, 0), pixels from the image's middle
};

/// The sums of one sample.
struct GatherSums {
  glm::dvec3 color{0.0};  ///< C, the premultiplied radiance
  double energy = 0.0;    ///< E, which is 1 minus the transmittance of the sample's ray
  double distance = 0.0;  ///< sum of e times the distance from the eye plane, world units; negative: unknown
};

/// The blocks of one level of the octree as the march reads them, x fastest.
struct GatherBlocks {
  glm::ivec3 dimensions{0};
  std::vector<double> extinction;  ///< per world unit
  std::vector<glm::dvec3> source;  ///< radiance that is sent to the eye per world unit; for samples that are lit, for light of 1
  std::vector<glm::dvec3> emission = {};  ///< radiance that is emitted per world unit, if it is not part of `source`; otherwise empty

  bool exists() const { return !extinction.empty(); }
};

/// The light at the blocks of one level, x fastest, where lights are evaluated at samples. Blocks without bricks have 0.
struct GatherLight {
  std::vector<std::vector<double>> depths;  ///< by light: optical depth towards it, for scalars from the next layer on that way
  /// Per block, of scalars in intervals of the transfer function's table, or of extinction; empty without surfaces.
  std::vector<glm::dvec3> gradients;
};

/// What the stages of a frame made, in the order in which they are made.
struct GatherStages {
  GatherLattice lattice;
  std::vector<LevelData> medium;        ///< by level: what the blocks are made of; empty where the frame reads no blocks
  std::vector<GatherBlocks> blocks;     ///< by level, for the same levels
  std::vector<GatherLight> light;       ///< by level; empty where the frame reads none
  std::optional<ScatteredField> scattered;  ///< none without such light
  std::vector<GatherSums> gathered;     ///< at the samples, x fastest
  std::vector<GatherSums> smoothed;     ///< after the stencil, which scalars do not have
  Image image;
};

/// Downloads the stages of the last gathered frame, without the image. Waits.
GatherStages downloadGatherStages(const Device& device, const BuiltVolume& built, const GatherVolume& volume, const GatherPass& pass);

}  // namespace freevoxels
