#pragma once
// Where the voxels of a volume come from: they are in memory, or in a file of which parts are read. Renderers take either as a whole, or
// box by box where the whole does not fit into the device's memory.

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>

#include "engine/core/stages.h"
#include "engine/volume/sparse_grid.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// A box of voxels, or of blocks of a level.
struct VoxelRange {
  glm::ivec3 first{0}, end{0};
  glm::ivec3 extent() const { return end - first; }
  bool operator==(const VoxelRange&) const = default;
};

/// A volume and, where they are stored, coarser levels of it: a voxel of level l is the mean of a cube of 2^l voxels of level 0, at the
/// same place in the world. Any thread may call the member functions.
class VolumeSource {
 public:
  virtual ~VolumeSource() = default;

  /// Whether the values are in memory, and not read when they are used.
  virtual bool isInMemory() const = 0;
  virtual int levels() const = 0;
  /// The level as a volume without values.
  virtual const Volume& outline(int level = 0) const = 0;
  /// Marks the bricks (ScalarBricks) of a level that have data, with 1.
  virtual SparseGrid<std::uint8_t> bricks(int level = 0) const = 0;
  /// A box of a level as a volume of its own, which keeps the whole level's ranges and has its part of the bricks. The box begins at
  /// multiples of ScalarBricks::kEdge, and ends at such or with the level. A file fails with ErrorKind::Input where it is damaged.
  virtual Volume read(int level, const VoxelRange& box) const = 0;
  /// Level 0 with its values. A file is read anew by each call; `progress` may abandon that. Fails as read() does, and with
  /// ErrorKind::OutOfMemory of the host.
  virtual std::shared_ptr<const Volume> whole(const Progress& progress = {}) const = 0;
  /// A text that differs where the values of two files do, without reading them; empty for values in memory.
  virtual std::string checksum() const { return {}; }
};

/// A volume in memory, of one level.
class VolumeInMemory : public VolumeSource {
 public:
  explicit VolumeInMemory(std::shared_ptr<const Volume> volume);

  bool isInMemory() const override { return true; }
  int levels() const override { return 1; }
  const Volume& outline(int) const override { return outline_; }
  SparseGrid<std::uint8_t> bricks(int) const override;
  Volume read(int level, const VoxelRange& box) const override;
  std::shared_ptr<const Volume> whole(const Progress&) const override { return volume_; }

 private:
  const std::shared_ptr<const Volume> volume_;
  const Volume outline_;
};

/// What is known of a volume without reading it: all of one in memory, the outline of a file.
std::shared_ptr<const Volume> known(const std::shared_ptr<const VolumeSource>& source);

/// How many voxels the bricks with data of a source have.
std::uint64_t brickVoxels(const VolumeSource& source);

}  // namespace freevoxels
