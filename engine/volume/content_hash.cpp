#include "engine/volume/content_hash.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <memory>
#include <span>
#include <type_traits>

namespace freevoxels {

namespace {

class Hash {
 public:
  Hash() { XXH3_128bits_reset(state_.get()); }
  /// Values without padding between or in them.
  template <typename T>
  void add(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    XXH3_128bits_update(state_.get(), values.data(), values.size_bytes());
  }
  template <typename T>
  void add(const T& value) {
    add(std::span(&value, 1));
  }
  std::string digits() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_{XXH3_createState()};
};

/// Bricks by their place, not in the order in which they were made.
void addBricks(Hash& hash, const ScalarBricks& bricks) {
  hash.add(bricks.dimensions());
  hash.add(bricks.corner());
  for (const std::size_t brick : bricks.inOrder()) {
    hash.add(bricks.cell(brick));
    hash.add(std::span<const float>(bricks.brick(brick)));
  }
}

}  // namespace

std::string contentHash(const Volume& volume, const Classification& classification, const Environment* environment) {
  Hash hash;
  hash.add(volume.indexToWorld);
  forEachGrid([&](const ScalarBricks& grid) { addBricks(hash, grid); }, volume);
  if (const auto& function = classification.transferFunction) {
    for (const TransferFunction::OpacityPoint& point : function->opacity) hash.add(point);
    for (const TransferFunction::ColorPoint& point : function->color) hash.add(point);
    hash.add(function->unitDistance);
  }
  if (environment != nullptr) {
    hash.add(environment->size);
    hash.add(std::span<const glm::vec3>(environment->radiance));
  }
  return hash.digits();
}

std::string contentHash(const Holdout& holdout) {
  Hash hash;
  hash.add(holdout.size);
  hash.add(std::span<const float>(holdout.depths));
  return hash.digits();
}

}  // namespace freevoxels
