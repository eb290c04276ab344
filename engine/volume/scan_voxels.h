#pragma once
// The bricks of a scan, filled block by block with numbers of any type.

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <shared_mutex>
#include <variant>
#include <vector>

#include "engine/volume/sample_type.h"
#include "engine/volume/scalar_bricks.h"

namespace freevoxels {

/// Samples of a box of voxels, x fastest, without gaps.
struct SampleBlock {
  const std::byte* samples = nullptr;
  SampleType type = SampleType::U8;
  int components = 1;                   ///< numbers of a voxel, which follow each other
  bool isSwapped = false;               ///< whether the order of their bytes is not this machine's
  double slope = 1.0, intercept = 0.0;  ///< a voxel is sample x slope + intercept
  glm::ivec3 first{0}, extent{0};
};
using SampleSink = std::function<void(const SampleBlock&)>;

/// All bricks of a box, which take their final memory at once: beside them only the block that is put in exists. Numbers of 8 and 16 bits
/// are kept as such, as long as all blocks have the same.
class ScanVoxels {
 public:
  /// The box begins at a voxel of the scan. `type` is that of the blocks, as far as is known, if they fill the box: otherwise F32.
  ScanVoxels(SampleType type, glm::ivec3 dimensions, glm::ivec3 first = glm::ivec3(0));
  /// Takes one of the numbers of the voxels that are in the box. Several threads may call it.
  void put(const SampleBlock& block, int component = 0);
  /// The bricks, once.
  ScalarBricks take();

  /// Bytes of a voxel of numbers of a type.
  static std::size_t bytesOfVoxel(SampleType type);

 private:
  /// Which value a code has.
  struct Scale {
    double slope, intercept;
    bool operator==(const Scale&) const = default;
  };
  /// Whether the numbers of a block can be kept as they are, or as floats.
  bool takes(const SampleBlock& block) const;
  void useFloats();
  template <typename Value, typename Stored, typename Convert>
  void fill(const SampleBlock& block, int component, ScalarBricks::BricksOf<Stored>& bricks, const Convert& convert) const;
  std::vector<float> valuesOfCodes() const;

  SampleType type_;
  glm::ivec3 dimensions_, first_, cells_;
  std::shared_mutex mutex_;  ///< exclusive while codes become floats, or the scale is set
  std::optional<Scale> scale_;
  std::variant<ScalarBricks::Bricks, ScalarBricks::BricksOf<std::uint8_t>, ScalarBricks::BricksOf<std::uint16_t>> bricks_;
};

}  // namespace freevoxels
