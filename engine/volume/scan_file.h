#pragma once
// Scans: files that hold one box of samples, such as those of medicine, microscopy and simulation. Which formats there are is said here,
// and nowhere else: isScanFile(), scanEndings() and readScan() are all that the rest of the program knows of them.

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/stages.h"
#include "engine/volume/channels.h"
#include "engine/volume/coarse_volume.h"
#include "engine/volume/labels.h"
#include "engine/volume/raw_layout.h"
#include "engine/volume/sample_type.h"
#include "engine/volume/scan.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// What is read of a file, and how.
struct ScanRequest {
  /// The name of the array to read of a file with several; else that which the file calls its scalars, or the only one. In a file with
  /// channels, the name or number of the one that is read alone.
  std::string array;
  std::vector<ChannelStyle> channels;  ///< of a file with channels, those that are drawn together; none: those that the file shows
  std::optional<int> pyramidLevel;     ///< of a file with several resolutions, from 0, the finest; else by imageEdge and memory
  std::uint64_t memoryBytes = std::numeric_limits<std::uint64_t>::max();  ///< that may be used, a quarter of it for such a file
  int imageEdge = 0;                   ///< pixels along the longer edge of the image; 0: unknown
  /// Of a file with several resolutions, the voxels that are read, all others being empty: of `pyramidLevel`, else of the finest level. Of
  /// other files all are read.
  std::optional<VoxelBox> clipBox;
  bool asColors = true;               ///< draws colours as such; else their luminance
  std::optional<RawLayout> raw;       ///< the file has values without a header; else the layout of its name (layoutOfName)
  std::optional<std::string> series;  ///< UID of a DICOM series; else the only one of the folder, or that of the file
  std::optional<int> timeStep;        ///< of a file with several, from 0; else the first
  std::optional<glm::dvec3> spacing;  ///< millimetres between voxels along the axes of the box, instead of the file's; above 0
  std::optional<NoData> noData;       ///< else the padding of a scan (scan.h)
  const Labels* labels = nullptr;     ///< how the values are drawn if they are labels; else null
  std::uint64_t maximumVoxels = 0;    ///< of the box
  Progress progress = {};             ///< may abandon it
};

/// One of several values at the same voxels, as a file describes it.
struct ScanChannel {
  std::string name;                            ///< may be empty
  std::optional<glm::vec3> color;              ///< linear Rec.709, 0..1
  std::optional<std::array<float, 2>> window;  ///< of the values, as ChannelStyle::window
  bool isShown = true;                         ///< whether the file says that it is drawn

  bool operator==(const ScanChannel&) const = default;
};

/// Where the coordinates of a scan are from.
enum class ScanSpace {
  File,         ///< axes of the file, in a unit that it does not say
  Millimetres,  ///< axes of the file
  Patient       ///< LPS millimetres: x towards the patient's left, y towards the back, z towards the head
};

/// What a scan's header says.
struct ScanHeader {
  std::string format;  ///< "NIfTI", "DICOM series of 120 slices"
  std::string array;   ///< name of the values; empty where they have none
  glm::ivec3 dimensions{0};
  int timeSteps = 1;
  SampleType type = SampleType::U8;  ///< of the values in the file
  int components = 1;                ///< numbers of a voxel that follow each other in the file; 3 or 4 of colours
  glm::dmat4 indexToWorld{1.0};      ///< from voxels to the world
  ScanSpace space = ScanSpace::File;
  std::optional<glm::dvec2> rescale;  ///< slope and intercept, which the values that are read have been multiplied by and added to
  std::vector<ScanChannel> channels;  ///< of a file with several
  bool areColors = false;             ///< whether the channels are red, green, blue and maybe opacity
  std::vector<glm::ivec3> levels;     ///< dimensions of a file with several resolutions, the finest first
  int level = 0;                      ///< which of them `dimensions` and `indexToWorld` are of
  std::optional<VoxelBox> part;       ///< the voxels of `dimensions` that are read; none: all
  std::vector<std::string> remarks;   ///< what was chosen, as Volume::remarks
  std::string valueUnit;              ///< "HU"; empty where the file does not say it

  std::uint64_t samples() const { return std::uint64_t(dimensions.x) * std::uint64_t(dimensions.y) * std::uint64_t(dimensions.z); }
  std::uint64_t bytesOfVoxel() const { return bytesOf(type) * std::uint64_t(components); }
};

/// Whether it is read as a scan: by the ending of its name, as a folder, or as DICOM by its content.
bool isScanFile(const std::filesystem::path& file);
/// Whether the name alone says so.
bool hasScanEnding(const std::filesystem::path& file);
/// The endings of names that are those of scans, in lower case: ".nii.gz", ".nrrd", ...
std::span<const std::string_view> scanEndings();
/// The name of a file without its ending, of which those of scans may have two parts: "head" of "a/head.nii.gz".
std::string stemOf(const std::filesystem::path& file);

/// Fails as readScan does, but reads no values.
ScanHeader readScanHeader(const std::filesystem::path& file, const ScanRequest& request);
/// How the channels are drawn that readScan mixes, with the colours and windows of the file where the request gives none; none where a
/// single channel is read.
std::vector<ChannelStyle> scanChannels(const std::filesystem::path& file, const ScanRequest& request);
/// Reads the samples, those of 8 and 16 bits as codes (scalar_bricks.h) and others as floats, or colours (colors.h). Up is +z, towards the
/// head. Fails with ErrorKind::Input for a file that is missing, damaged, shorter than its header says, of vectors, or has several series
/// of which none is chosen; with ErrorKind::OutOfMemory if the box exceeds `maximumVoxels` or this machine's memory, before allocating it;
/// and with ErrorKind::Usage for parts of the request that the file has no use for.
Volume readScan(const std::filesystem::path& file, const ScanRequest& request);

}  // namespace freevoxels
