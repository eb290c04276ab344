#pragma once
// The continuous field through which the oracle marches. Pre: every voxel is classified first, then
// extinction, extinction times colour, and emission are interpolated trilinearly between voxel centres. Post:
// scalars are interpolated trilinearly and every point is classified. Inactive voxels and positions beyond
// the outermost centres have no data, so that the field falls to 0 over one more voxel: for Post the
// extinction is that of the mean scalar of the voxels with data, times their part of the interpolation's
// weights.

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
/// space, and the cells from -1 to dimensions - 1 contain the field. Bricks of 8³ cells, the first of which
/// starts at cell -1, store the values at all their cells' corners. A brick without extinction does not
/// exist. Emission has its own bricks.
class ReferenceField {
 public:
  static constexpr int kBrickCells = 8;
  static constexpr int kBrickCorners = kBrickCells + 1;

  /// Extinction times colour (rgb) and extinction (a), per world unit, at the corners of a brick's cells, x
  /// fastest: classified in double precision, stored with 24 bits. Post: the scalar (r) and 1 (a), or 0
  /// without data.
  using Brick = std::array<glm::vec4, kBrickCorners * kBrickCorners * kBrickCorners>;

  /// Whether a cell of a brick has extinction. `cell` counts from the brick's first.
  bool isFilled(const Brick& brick, glm::ivec3 cell) const;
  /// Post: the transfer function's integral. Null for Pre.
  const TransferIntegral* integral() const { return integral_ ? &*integral_ : nullptr; }

  ReferenceField(const Volume& volume, const Classification& classification, const Progress& progress = {});

  glm::ivec3 dimensions() const { return dimensions_; }
  glm::ivec3 brickCount() const { return brickCount_; }
  /// The colour, if all voxels have the same.
  const std::optional<glm::dvec3>& evenColor() const { return evenColor_; }
  /// The brick of emission per world unit (rgb; a is 0). Null where there is none.
  const Brick* emission(glm::ivec3 position) const {
    return emission_.empty() ? nullptr : emission_[indexOf(position)].get();
  }
  /// The brick at a position, or null if its extinction is 0 everywhere. Its cells start at 8 * position - 1.
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
  std::vector<std::unique_ptr<Brick>> bricks_, emission_;  ///< `emission_` is empty if no voxel emits light
};

}  // namespace freevoxels
