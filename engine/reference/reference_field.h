#pragma once
// The continuous field that the oracle marches through. Pre: every voxel classified first, then extinction,
// extinction times colour and light of its own interpolated trilinearly between the voxel centres. Post: scalars
// interpolated trilinearly, and the transfer function applied at every point. Beyond the outermost centres and at
// inactive voxels there is nothing, so that the field falls to 0 over one more voxel: post, the extinction is that
// of the mean scalar of the voxels that have one, times their share of the interpolation's weights.

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "engine/core/stages.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"
#include "engine/volume/voxel_classifier.h"

namespace freevoxels {

/// A cell is the cube between eight neighbouring voxel centres: cell c reaches from c to c + 1 in index
/// space, and the cells from -1 to dimensions - 1 hold the field. Bricks of 8³ cells, the first at cell -1,
/// keep the values at all their cells' corners; a brick without any extinction is not there at all. Light has
/// bricks of its own.
class ReferenceField {
 public:
  static constexpr int kBrickCells = 8;
  static constexpr int kBrickCorners = kBrickCells + 1;

  /// Extinction times colour (rgb) and extinction (a), per world unit, at the corners of a brick's cells, x
  /// fastest: classified in double precision, kept to 24 bits. Post: the scalar (r) and 1 (a), or 0 without data.
  using Brick = std::array<glm::vec4, kBrickCorners * kBrickCorners * kBrickCorners>;

  /// Whether there is extinction in a brick's cell. `cell` counts from the brick's first.
  bool isFilled(const Brick& brick, glm::ivec3 cell) const;
  /// Post: the transfer function's integral; null of a field of classified voxels.
  const TransferIntegral* integral() const { return integral_ ? &*integral_ : nullptr; }

  ReferenceField(const Volume& volume, const Classification& classification, const Progress& progress = {});

  glm::ivec3 dimensions() const { return dimensions_; }
  glm::ivec3 brickCount() const { return brickCount_; }
  /// Where all voxels have one colour.
  const std::optional<glm::dvec3>& evenColor() const { return evenColor_; }
  /// Light that is sent out per world unit (rgb; a is 0), as the others. Null where there is none.
  const Brick* light(glm::ivec3 position) const {
    return light_.empty() ? nullptr : light_[indexOf(position)].get();
  }
  /// Null where the extinction is 0 throughout. The brick's cells start at 8 * position - 1.
  const Brick* brick(glm::ivec3 position) const { return bricks_[indexOf(position)].get(); }

 private:
  std::size_t indexOf(glm::ivec3 position) const {
    return std::size_t(position.x) +
           std::size_t(brickCount_.x) *
               (std::size_t(position.y) + std::size_t(brickCount_.y) * std::size_t(position.z));
  }

  glm::ivec3 dimensions_, brickCount_;
  std::optional<glm::dvec3> evenColor_;
  std::optional<TransferIntegral> integral_;
  std::vector<std::unique_ptr<Brick>> bricks_, light_;  ///< `light_` is empty where no voxel sends out any
};

}  // namespace freevoxels
