#pragma once
// A fog volume of an OpenVDB file that need not fit into memory: values stay in the file until the part that they are in is read.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/volume/scan.h"
#include "engine/volume/vdb.h"
#include "engine/volume/volume.h"

namespace freevoxels {

class VdbParts {
 public:
  /// Null where the values of the grid take at most `mostBytes`, and where they have to be read at once: those of level sets, of grids
  /// that are not float or half, of volumes whose temperatures or albedos are required, of files that were streamed out, and all with an
  /// OpenVDB without delayed loading. Chooses the grids and fails as readVdb does.
  static std::unique_ptr<VdbParts> open(const std::filesystem::path& file, const ReadRequest& request, std::uint64_t mostBytes);
  ~VdbParts();

  /// What readVdb returns, without bricks.
  const Volume& outline() const { return outline_; }
  /// Single voxels at equal distances, at most 256 along an edge, with the range, the counts of unusual values and the warnings of the whole.
  const Volume& sample() const { return sample_; }
  /// The cells, in cubes of edge^3 voxels, of those that may hold something.
  std::vector<glm::ivec3> occupied(int edge) const;
  /// A cube of edge^3 voxels of the box as a volume, summarised; without data beyond the box. Several threads may read. Fails with
  /// ErrorKind::Input if the file is damaged.
  Volume read(glm::ivec3 first, int edge) const;

 private:
  struct Source;
  VdbParts(std::unique_ptr<Source> source, const std::optional<NoData>& noData);
  void sumUp();
  Volume readValues(glm::ivec3 first, int edge) const;

  std::unique_ptr<Source> source_;
  Volume outline_, sample_;
};

}  // namespace freevoxels
