#pragma once
// Internal to the readers of scans.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/stages.h"
#include "engine/volume/raw_layout.h"
#include "engine/volume/scan_file.h"
#include "engine/volume/scan_voxels.h"

namespace freevoxels {

/// Which samples of a file are read.
struct ScanPart {
  int timeStep = 0;
  int channel = 0;                             ///< of a file whose channels do not follow each other in every voxel
  std::optional<VoxelBox> box = std::nullopt;  ///< blocks beyond it may be left out
};

/// A scan of which the header was read and checked.
class ScanReader {
 public:
  virtual ~ScanReader() = default;
  const ScanHeader& header() const { return header_; }
  /// Hands out all samples of a part, rescaled, in blocks, by several threads. Fails with ErrorKind::Input where the file is damaged.
  virtual void read(const ScanPart& part, const SampleSink& sink, const Progress& progress) = 0;
  /// Host memory that read() needs besides the sink's.
  virtual std::uint64_t bytesToRead() const = 0;
  /// Whether read() hands out every voxel of its part.
  virtual bool fillsBox() const { return true; }

 protected:
  ScanHeader header_;
};

std::unique_ptr<ScanReader> openRawScan(const std::filesystem::path& file, const RawLayout& layout);
/// `array`: as in ScanRequest.
std::unique_ptr<ScanReader> openVtiScan(const std::filesystem::path& file, const std::string& array);

/// A hierarchy of Zarr arrays in a folder or in a zip archive. `request` has the level or what it is chosen by.
std::unique_ptr<ScanReader> openNgffScan(const std::filesystem::path& file, const ScanRequest& request);
/// The pages of a file, or the files of a folder.
std::unique_ptr<ScanReader> openTiffScan(const std::filesystem::path& file);

/// The formats of single files that ITK reads.
enum class ItkFormat { Nrrd, MetaImage, Nifti, Vtk };
std::unique_ptr<ScanReader> openItkScan(const std::filesystem::path& file, ItkFormat format);
/// A DICOM file, the series that it is of, or a series of a folder.
std::unique_ptr<ScanReader> openDicomScan(const std::filesystem::path& file, const std::optional<std::string>& series);

[[noreturn]] inline void failDamaged(const std::filesystem::path& file, std::string_view why) {
  fail(ErrorKind::Input, "cannot read '{}': {}; the file is damaged, or was cut: copy or download it again", file.string(), why);
}

/// Whether so many numbers of a voxel are colours.
bool areColors(int components, SampleType type);
/// Fails for several numbers of a voxel that are no colours.
void checkComponents(const std::filesystem::path& file, int components, SampleType type);
/// Fails for edges of a box that are not 1 to 2^20.
void checkEdges(const std::filesystem::path& file, const glm::i64vec3& dimensions);
/// Fails where a file of `fileBytes` cannot hold `bytes` of values, not even compressed by zlib.
void checkPayload(const std::filesystem::path& file, std::uint64_t bytes, std::uint64_t fileBytes, bool isCompressed);

}  // namespace freevoxels
