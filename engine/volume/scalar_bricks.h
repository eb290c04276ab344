#pragma once
// The scalars of a box of voxels of any size, in bricks of which only those with data take memory. Scalars of 8 or 16 bits, as scans have
// them, may be kept as codes: numbers of a list of values.

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
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
  static constexpr std::size_t kVoxels = std::size_t(kEdge) * kEdge * kEdge;
  template <typename Value>
  using BrickOf = std::array<Value, kVoxels>;  ///< x fastest
  template <typename Value>
  using BricksOf = std::vector<BrickOf<Value>, UnsetAllocator<BrickOf<Value>>>;
  using Brick = BrickOf<float>;
  using Bricks = BricksOf<float>;

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
  /// The same of codes (ofCodes()), which `codeAt(voxel)` returns.
  template <typename Code, typename Function>
  static ScalarBricks makeCodes(glm::ivec3 dimensions, const Function& codeAt, std::vector<float> values, const Progress& progress = {});
  /// Takes over existing bricks, one for each of `cells`, which are in the box and differ. Voxels of bricks that are beyond the box must
  /// be inactive.
  static ScalarBricks of(glm::ivec3 dimensions, std::vector<glm::ivec3> cells, Bricks bricks);
  /// The same of codes of 8 or 16 bits: the scalar of a voxel is `values[code]`, which may be kInactiveVoxel. There is a value for each
  /// code. Those of voxels beyond the box do not matter.
  template <typename Code>
  static ScalarBricks ofCodes(glm::ivec3 dimensions, std::vector<glm::ivec3> cells, BricksOf<Code> bricks, std::vector<float> values);

  const glm::ivec3& dimensions() const { return dimensions_; }
  /// Number of bricks along the axes, whether or not they exist.
  const glm::ivec3& cells() const { return numbers_.dimensions(); }
  /// Position of the box's voxel (0,0,0) in its brick.
  const glm::ivec3& corner() const { return corner_; }
  float at(glm::ivec3 voxel) const {
    const glm::ivec3 place = voxel + corner_;
    const std::int32_t number = numbers_.at(place / kEdge);
    return number < 0 ? kInactiveVoxel : scalarAt(std::size_t(number), indexInBrick(place % kEdge));
  }
  /// Sets a voxel, making its brick if it does not exist.
  void set(glm::ivec3 voxel, float scalar) {
    const glm::ivec3 place = voxel + corner_;
    makeBrick(place / kEdge)[indexInBrick(place % kEdge)] = scalar;
  }
  /// Returns brick `cell`, making it if it does not exist. The reference is valid until the next brick is
  /// made, or for as many bricks as were reserved. The cell is in the box. Voxels of the brick beyond the box must stay inactive. Codes
  /// become floats.
  Brick& makeBrick(glm::ivec3 cell);
  void reserve(std::size_t bricks);

  /// How many bricks exist. They are numbered in the order in which they were made.
  std::size_t count() const { return cells_.size(); }
  /// The scalars of a brick.
  Brick brick(std::size_t number) const;
  /// One of them, of a voxel in the box.
  float scalarAt(std::size_t number, std::size_t indexInBrick) const {
    const Bricks* const floats = std::get_if<Bricks>(&bricks_);
    return floats != nullptr ? (*floats)[number][indexInBrick] : decoded(number, indexInBrick);
  }
  /// The bricks, to be changed. Codes become floats.
  std::span<Brick> editable();
  /// Position in the box of a brick's first voxel; negative if the brick begins before the box.
  glm::ivec3 firstVoxel(std::size_t brick) const { return cells_[brick] * kEdge - corner_; }
  /// Position of a brick among the bricks of the box. Boxes of equal `corner` have the same voxels in the
  /// same bricks.
  glm::ivec3 cell(std::size_t brick) const { return cells_[brick]; }
  /// The number of the brick at a cell, if it exists.
  std::optional<std::size_t> numberAt(glm::ivec3 cell) const {
    const std::int32_t number = numbers_.at(cell);
    return number < 0 ? std::nullopt : std::optional(std::size_t(number));
  }
  /// The value of each code; empty where the scalars are floats.
  std::span<const float> values() const { return values_; }
  /// Changes the value of each code.
  std::span<float> values() { return values_; }
  /// How many voxels have each code.
  std::vector<std::uint64_t> codeCounts() const;
  /// Fills `to` with what a function makes of the scalars of a brick: with `ofScalar` of floats, and for codes with the elements of
  /// `ofCodes`, which mapValues() made with the same function.
  template <typename To, typename Function>
  void mapBrick(std::size_t brick, std::span<To> to, const Function& ofScalar, std::span<const To> ofCodes) const;
  template <typename To, typename Function>
  std::vector<To> mapValues(const Function& ofScalar) const {
    std::vector<To> mapped(values_.size());
    std::ranges::transform(values_, mapped.begin(), ofScalar);
    return mapped;
  }
  /// Copies the voxels of a row in the order of x. `row` must have as many elements as the box has voxels
  /// along x.
  void copyRow(int y, int z, std::span<float> row) const {
    mapRow(
        y, z, row, [](float scalar) { return scalar; }, values());
  }
  /// The same of what a function makes of them, as mapBrick() does.
  template <typename To, typename Function>
  void mapRow(int y, int z, std::span<To> row, const Function& ofScalar, std::span<const To> ofCodes) const;
  /// The numbers of the bricks in the order of their cells, x fastest.
  std::vector<std::size_t> inOrder() const;
  /// The part of the box from voxel `low` to `high`. Beyond this box there is no data.
  ScalarBricks cropped(glm::ivec3 low, glm::ivec3 high) const;
  /// Bytes that the bricks and their index take on the host.
  std::uint64_t bytes() const;
  /// The same of a number of bricks, without their index.
  static std::uint64_t bytesOf(std::uint64_t bricks, std::size_t bytesOfVoxel = sizeof(float)) {
    return bricks * (kVoxels * bytesOfVoxel + sizeof(glm::ivec3));
  }

  static glm::ivec3 placeInBrick(std::size_t index) {
    const int i = int(index);
    return {i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge)};
  }
  static std::size_t indexInBrick(glm::ivec3 place) {
    return std::size_t(place.x + kEdge * (place.y + kEdge * place.z));
  }

 private:
  template <typename Value, typename Function, typename Predicate, typename IsAbsent>
  static ScalarBricks fill(glm::ivec3 dimensions, const Function& valueAt, const Predicate& mayHoldData, Value absent,
                           const IsAbsent& isAbsent, const Progress& progress);
  void number(std::vector<glm::ivec3> cells);
  void checkCell(glm::ivec3 cell) const;
  float decoded(std::size_t number, std::size_t indexInBrick) const;
  /// Calls `visit` with the places in a brick that are beyond the box.
  template <typename Visit>
  void forEachBeyond(std::size_t brick, const Visit& visit) const;

  glm::ivec3 dimensions_{0}, corner_{0};
  SparseGrid<std::int32_t> numbers_{glm::ivec3(0), -1};  ///< index of each cell's brick, -1 if it does not exist
  std::vector<glm::ivec3> cells_;                        ///< cell of each brick
  std::variant<Bricks, BricksOf<std::uint8_t>, BricksOf<std::uint16_t>> bricks_;
  std::vector<float> values_;  ///< of codes; those of voxels beyond the box do not matter
};

template <typename Visit>
void ScalarBricks::forEachBeyond(std::size_t brick, const Visit& visit) const {
  const glm::ivec3 first = firstVoxel(brick), begin = glm::max(-first, glm::ivec3(0)),
                   end = glm::min(dimensions_ - first, glm::ivec3(kEdge));
  if (begin == glm::ivec3(0) && end == glm::ivec3(kEdge)) return;
  for (glm::ivec3 v(0); v.z < kEdge; ++v.z)
    for (v.y = 0; v.y < kEdge; ++v.y)
      for (v.x = 0; v.x < kEdge; ++v.x)
        if (glm::any(glm::lessThan(v, begin)) || glm::any(glm::greaterThanEqual(v, end))) visit(indexInBrick(v));
}

template <typename To, typename Function>
void ScalarBricks::mapBrick(std::size_t brick, std::span<To> to, const Function& ofScalar, std::span<const To> ofCodes) const {
  if (const Bricks* const floats = std::get_if<Bricks>(&bricks_)) {
    std::ranges::transform((*floats)[brick], to.begin(), ofScalar);
    return;
  }
  const auto decode = [&](const auto& bricks) {
    if constexpr (!std::is_same_v<decltype(bricks), const Bricks&>)
      std::ranges::transform(bricks[brick], to.begin(), [&](auto code) { return ofCodes[code]; });
  };
  std::visit(decode, bricks_);
  forEachBeyond(brick, [&](std::size_t voxel) { to[voxel] = ofScalar(kInactiveVoxel); });
}

template <typename To, typename Function>
void ScalarBricks::mapRow(int y, int z, std::span<To> row, const Function& ofScalar, std::span<const To> ofCodes) const {
  const glm::ivec3 place(0, y + corner_.y, z + corner_.z);
  for (int cell = 0; cell < cells().x; ++cell) {
    const int begin = std::max(cell * kEdge - corner_.x, 0), end = std::min((cell + 1) * kEdge - corner_.x, dimensions_.x);
    const std::span<To> to = row.subspan(std::size_t(begin), std::size_t(end - begin));
    const std::optional<std::size_t> brick = numberAt({cell, place.y / kEdge, place.z / kEdge});
    if (!brick) {
      std::ranges::fill(to, ofScalar(kInactiveVoxel));
      continue;
    }
    const std::size_t first = indexInBrick({(begin + corner_.x) % kEdge, place.y % kEdge, place.z % kEdge});
    const auto map = [&](const auto& bricks) {
      const auto from = std::span(bricks[*brick]).subspan(first, to.size());
      if constexpr (std::is_same_v<decltype(bricks), const Bricks&>)
        std::ranges::transform(from, to.begin(), ofScalar);
      else
        std::ranges::transform(from, to.begin(), [&](auto code) { return ofCodes[code]; });
    };
    std::visit(map, bricks_);
  }
}

template <typename Value, typename Function, typename Predicate, typename IsAbsent>
ScalarBricks ScalarBricks::fill(glm::ivec3 dimensions, const Function& valueAt, const Predicate& mayHoldData, Value absent,
                                const IsAbsent& isAbsent, const Progress& progress) {
  constexpr std::size_t kBatch = 512;  // bricks, which take a tenth of a second even where a voxel takes a microsecond
  ScalarBricks result(dimensions);
  BricksOf<Value>& bricks = result.bricks_.emplace<BricksOf<Value>>();
  std::vector<glm::ivec3> existing;
  const glm::ivec3 cells = result.cells();
  const std::size_t inLayer = std::size_t(cells.x) * std::size_t(cells.y), total = inLayer * std::size_t(cells.z);
  const auto cellOf = [&](std::size_t number) {
    return glm::ivec3(int(number % std::size_t(cells.x)), int(number % inLayer / std::size_t(cells.x)), int(number / inLayer));
  };
  // Batch by batch, so that the bricks have the same order in every run.
  std::vector<std::optional<BrickOf<Value>>> batch(std::min(progress ? kBatch : inLayer, total));
  for (std::size_t begin = 0; begin < total; begin += batch.size()) {
    if (progress) progress("making voxels", double(begin) / double(total));
    batch.resize(std::min(batch.size(), total - begin));
    tbb::parallel_for(std::size_t(0), batch.size(), [&](std::size_t i) {
      const glm::ivec3 first = cellOf(begin + i) * kEdge;
      batch[i].reset();
      if (!mayHoldData(first)) return;
      const glm::ivec3 end = glm::min(dimensions - first, glm::ivec3(kEdge));
      BrickOf<Value>& brick = batch[i].emplace();
      brick.fill(absent);
      bool isEmpty = true;
      for (glm::ivec3 v(0); v.z < end.z; ++v.z)
        for (v.y = 0; v.y < end.y; ++v.y)
          for (v.x = 0; v.x < end.x; ++v.x) {
            const Value value = brick[indexInBrick(v)] = valueAt(first + v);
            isEmpty = isEmpty && isAbsent(value);
          }
      if (isEmpty) batch[i].reset();
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!batch[i]) continue;
      existing.push_back(cellOf(begin + i));
      bricks.push_back(*batch[i]);
    }
  }
  result.number(std::move(existing));
  return result;
}

template <typename Function, typename Predicate>
ScalarBricks ScalarBricks::make(glm::ivec3 dimensions, const Function& scalarAt, const Predicate& mayHoldData, const Progress& progress) {
  return fill(
      dimensions, scalarAt, mayHoldData, kInactiveVoxel, [](float scalar) { return scalar == kInactiveVoxel; }, progress);
}

template <typename Code, typename Function>
ScalarBricks ScalarBricks::makeCodes(glm::ivec3 dimensions, const Function& codeAt, std::vector<float> values, const Progress& progress) {
  const auto isAbsent = [&](Code code) { return values[code] == kInactiveVoxel; };
  ScalarBricks result = fill(
      dimensions, codeAt, [](glm::ivec3) { return true; }, Code(0), isAbsent, progress);
  result.values_ = std::move(values);
  return result;
}

}  // namespace freevoxels
