#pragma once
// A baked volume whose levels of detail are read box by box, or as a whole.

#include <memory>
#include <string>
#include <vector>

#include "engine/storage/fvx_file.h"
#include "engine/volume/coarse_volume.h"
#include "engine/volume/volume_source.h"

namespace freevoxels {

class BakedSource : public VolumeSource {
 public:
  /// Level `finest` of the file takes the place of the voxels.
  explicit BakedSource(std::shared_ptr<const fvx::FvxFile> file, int finest = 0);

  const fvx::FvxFile& file() const { return *file_; }
  bool isInMemory() const override { return false; }
  int levels() const override { return int(outlines_.size()); }
  const Volume& outline(int level) const override { return outlines_[std::size_t(level)]; }
  SparseGrid<std::uint8_t> bricks(int level) const override;
  Volume read(int level, const VoxelRange& box) const override;
  std::shared_ptr<const Volume> whole(const Progress& progress) const override;
  /// The checksum of the header, which has those of all sections.
  std::string checksum() const override;

 private:
  const std::shared_ptr<const fvx::FvxFile> file_;
  const int finest_;
  std::vector<Volume> outlines_;
};

/// The source of a file's level; in memory if `reads` says so, which fails with ErrorKind::OutOfMemory where this machine has too little.
/// `progress` may abandon it.
std::shared_ptr<const VolumeSource> bakedSource(const std::shared_ptr<const fvx::FvxFile>& file, int finest, bool reads,
                                                const Progress& progress = {});

/// The voxels of a box, which is cut to the volume's and must then have one, as clippedVolume has them of the whole: no others are read.
/// Fails with ErrorKind::OutOfMemory where this machine has too little, and as BakedSource::read() does.
Volume readBakedPart(const std::shared_ptr<const fvx::FvxFile>& file, const VoxelBox& box);

}  // namespace freevoxels
