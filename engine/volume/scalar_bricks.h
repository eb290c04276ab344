#pragma once
// The scalars of a box of voxels of any size, in bricks of which only those with data take memory.

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/stages.h"
#include "engine/volume/sparse_grid.h"
#include "shaders/interface.h"

namespace freevoxels {

/// The scalar of voxels without data (inactive in OpenVDB). They are never drawn, whatever the
/// classification.
inline constexpr float kInactiveVoxel = -std::numeric_limits<float>::max();

/// Leaves new elements of a vector as their memory is: setting them to 0 first takes as long as reading them from a file.
template <typename Value>
struct UnsetAllocator : std::allocator<Value> {
  template <typename Other>
  struct rebind {
    using other = UnsetAllocator<Other>;
  };
  template <typename Element>
  void construct(Element* place) {
    ::new (static_cast<void*>(place)) Element;
  }
  template <typename Element, typename... Args>
  void construct(Element* place, Args&&... args) {
    ::new (static_cast<void*>(place)) Element(std::forward<Args>(args)...);
  }
};

class ScalarBricks {
 public:
  static constexpr int kEdge = shader::kBrickEdge;
  using Brick = std::array<float, std::size_t(kEdge) * kEdge * kEdge>;  ///< x fastest
  using Bricks = std::vector<Brick, UnsetAllocator<Brick>>;

  ScalarBricks() = default;
  /// A box without data. Its voxel (0,0,0) is voxel `corner` of its brick, with components 0 to kEdge - 1.
  explicit ScalarBricks(glm::ivec3 dimensions, glm::ivec3 corner = glm::ivec3(0));
  /// Makes bricks from a function. `scalarAt(voxel)` is called once for each voxel, by several threads,
  /// except for the bricks for whose first voxel `mayHoldData` is false.
  template <typename Function, typename Predicate>
  static ScalarBricks make(glm::ivec3 dimensions, const Function& scalarAt, const Predicate& mayHoldData, const Progress& progress = {});
  template <typename Function>
  static ScalarBricks make(glm::ivec3 dimensions, const Function& scalarAt) {
    return make(dimensions, scalarAt, [](glm::ivec3) { return true; });
  }
  /// Takes over existing bricks, one for each of `cells`, which are in the box and differ. Voxels of bricks that are beyond the box must
  /// be inactive.
  static ScalarBricks of(glm::ivec3 dimensions, std::vector<glm::ivec3> cells, Bricks bricks);

  const glm::ivec3& dimensions() const { return dimensions_; }
  /// Number of bricks along the axes, whether or not they exist.
  const glm::ivec3& cells() const { return numbers_.dimensions(); }
  /// Position of the box's voxel (0,0,0) in its brick.
  const glm::ivec3& corner() const { return corner_; }
  float at(glm::ivec3 voxel) const {
    const glm::ivec3 place = voxel + corner_;
    const std::int32_t number = numbers_.at(place / kEdge);
    return number < 0 ? kInactiveVoxel : bricks_[std::size_t(number)][indexInBrick(place % kEdge)];
  }
  /// Sets a voxel, making its brick if it does not exist.
  void set(glm::ivec3 voxel, float scalar) {
    const glm::ivec3 place = voxel + corner_;
    makeBrick(place / kEdge)[indexInBrick(place % kEdge)] = scalar;
  }
  /// Returns brick `cell`, making it if it does not exist. The reference is valid until the next brick is
  /// made, or for as many bricks as were reserved. The cell is in the box. Voxels of the brick beyond the box must stay inactive.
  Brick& makeBrick(glm::ivec3 cell);
  void reserve(std::size_t bricks);

  /// The existing bricks, in the order in which they were made.
  std::span<Brick> bricks() { return bricks_; }
  std::span<const Brick> bricks() const { return bricks_; }
  /// Position in the box of a brick's first voxel; negative if the brick begins before the box.
  glm::ivec3 firstVoxel(std::size_t brick) const { return cells_[brick] * kEdge - corner_; }
  /// Position of a brick among the bricks of the box. Boxes of equal `corner` have the same voxels in the
  /// same bricks.
  glm::ivec3 cell(std::size_t brick) const { return cells_[brick]; }
  /// The brick at a cell, or null if it does not exist.
  const Brick* brickAt(glm::ivec3 cell) const {
    const std::int32_t number = numbers_.at(cell);
    return number < 0 ? nullptr : &bricks_[std::size_t(number)];
  }
  /// Copies the voxels of a row in the order of x. `row` must have as many elements as the box has voxels
  /// along x.
  void copyRow(int y, int z, std::span<float> row) const;
  /// The numbers of the bricks in the order of their cells, x fastest.
  std::vector<std::size_t> inOrder() const;
  /// The part of the box from voxel `low` to `high`. Beyond this box there is no data.
  ScalarBricks cropped(glm::ivec3 low, glm::ivec3 high) const;
  /// Bytes that the bricks and their index take on the host.
  std::uint64_t bytes() const { return bytesOf(bricks().size()) + numbers_.bytes(); }
  /// The same of a number of bricks, without their index.
  static std::uint64_t bytesOf(std::uint64_t bricks) { return bricks * (sizeof(Brick) + sizeof(glm::ivec3)); }

  static glm::ivec3 placeInBrick(std::size_t index) {
    const int i = int(index);
    return {i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge)};
  }
  static std::size_t indexInBrick(glm::ivec3 place) {
    return std::size_t(place.x + kEdge * (place.y + kEdge * place.z));
  }

 private:
  void number(std::vector<glm::ivec3> cells);
  void checkCell(glm::ivec3 cell) const;

  glm::ivec3 dimensions_{0}, corner_{0};
  SparseGrid<std::int32_t> numbers_{glm::ivec3(0), -1};  ///< index of each cell's brick, -1 if it does not exist
  std::vector<glm::ivec3> cells_;                        ///< cell of each brick
  Bricks bricks_;
};

template <typename Function, typename Predicate>
ScalarBricks ScalarBricks::make(glm::ivec3 dimensions, const Function& scalarAt,
                                const Predicate& mayHoldData, const Progress& progress) {
  constexpr std::size_t kBatch = 512;  // bricks, which take a tenth of a second even where a voxel takes a microsecond
  ScalarBricks result(dimensions);
  const glm::ivec3 cells = result.cells();
  const std::size_t inLayer = std::size_t(cells.x) * std::size_t(cells.y), total = inLayer * std::size_t(cells.z);
  const auto cellOf = [&](std::size_t number) {
    return glm::ivec3(int(number % std::size_t(cells.x)), int(number % inLayer / std::size_t(cells.x)), int(number / inLayer));
  };
  // Batch by batch, so that the bricks have the same order in every run.
  std::vector<std::optional<Brick>> batch(std::min(progress ? kBatch : inLayer, total));
  for (std::size_t begin = 0; begin < total; begin += batch.size()) {
    if (progress) progress("making voxels", double(begin) / double(total));
    batch.resize(std::min(batch.size(), total - begin));
    tbb::parallel_for(std::size_t(0), batch.size(), [&](std::size_t i) {
      const glm::ivec3 first = cellOf(begin + i) * kEdge;
      batch[i].reset();
      if (!mayHoldData(first)) return;
      const glm::ivec3 end = glm::min(dimensions - first, glm::ivec3(kEdge));
      Brick& brick = batch[i].emplace();
      brick.fill(kInactiveVoxel);
      for (glm::ivec3 v(0); v.z < end.z; ++v.z)
        for (v.y = 0; v.y < end.y; ++v.y)
          for (v.x = 0; v.x < end.x; ++v.x) brick[indexInBrick(v)] = scalarAt(first + v);
      if (std::ranges::all_of(brick, [](float scalar) { return scalar == kInactiveVoxel; })) batch[i].reset();
    });
    for (std::size_t i = 0; i < batch.size(); ++i)
      if (batch[i]) result.makeBrick(cellOf(begin + i)) = *batch[i];
  }
  return result;
}

}  // namespace freevoxels
