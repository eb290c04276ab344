#include "engine/volume/scan_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <deque>
#include <fstream>
#include <new>
#include <system_error>

#include "engine/core/crash_note.h"
#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/core/machine.h"
#include "engine/core/printable.h"
#include "engine/volume/scan_channels.h"
#include "engine/volume/scan_reader.h"
#include "engine/volume/volume_of_scalars.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

/// How a file is read. MRC maps are recognised to be refused in a sentence that helps.
enum class Format { Nrrd, MetaImage, Nifti, Tiff, Vtk, Vti, Dicom, Raw, Zarr, Mrc };

struct Ending {
  std::string_view ending;
  Format format;
};
/// Endings of file names. The first that fits counts, so that longer ones come before those that they end with.
constexpr std::array<Ending, 22> kEndings{
    {{".ome.zarr.zip", Format::Zarr}, {".zarr.zip", Format::Zarr}, {".ome.zarr", Format::Zarr}, {".zarr", Format::Zarr},
     {".ozx", Format::Zarr},          {".zip", Format::Zarr},      {".ome.tif", Format::Tiff},  {".ome.tiff", Format::Tiff},
     {".nii", Format::Nifti},         {".nii.gz", Format::Nifti},  {".nrrd", Format::Nrrd},     {".nhdr", Format::Nrrd},
     {".mha", Format::MetaImage},     {".mhd", Format::MetaImage}, {".vti", Format::Vti},       {".vtk", Format::Vtk},
     {".dcm", Format::Dicom},         {".ima", Format::Dicom},     {".tif", Format::Tiff},      {".tiff", Format::Tiff},
     {".raw", Format::Raw},           {".mrc", Format::Mrc}}};

/// The last component of a path, also of one that ends in a slash: "ct" for "scans/ct/".
std::string fileNameOf(const fs::path& file) {
  return (file.has_filename() ? file : file.parent_path()).filename().string();
}

std::string lowerName(const fs::path& file) {
  std::string name = fileNameOf(file);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return name;
}

const Ending* endingOf(const fs::path& file) {
  const std::string name = lowerName(file);
  const auto found = std::ranges::find_if(kEndings, [&](const Ending& one) { return name.ends_with(one.ending); });
  return found == kEndings.end() ? nullptr : &*found;
}

/// Whether the file begins as DICOM's do, whatever its name.
bool hasDicomSignature(const fs::path& file) {
  constexpr std::size_t kPreamble = 128;
  char bytes[kPreamble + 4] = {};
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes, sizeof(bytes));
  return stream && std::string_view(bytes + kPreamble, 4) == "DICM";
}

/// What a folder is: a Zarr hierarchy, slices of TIFF where none of its files is of DICOM, or else a series of DICOM.
Format formatOfFolder(const fs::path& folder) {
  std::error_code error;
  for (const char* metadata : {"zarr.json", ".zattrs", ".zgroup"})
    if (fs::exists(folder / metadata, error)) return Format::Zarr;
  bool hasTiff = false;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const Ending* const ending = endingOf(entry.path());
    if (ending != nullptr && ending->format == Format::Tiff)
      hasTiff = true;
    else if ((ending != nullptr && ending->format == Format::Dicom) || hasDicomSignature(entry.path()))
      return Format::Dicom;
  }
  return hasTiff ? Format::Tiff : Format::Dicom;
}

Format formatOf(const fs::path& file, const ScanRequest& request) {
  if (request.raw) return Format::Raw;
  std::error_code error;
  if (fs::is_directory(file, error)) return formatOfFolder(file);
  if (const Ending* ending = endingOf(file)) return ending->format;
  return Format::Dicom;
}

std::unique_ptr<ScanReader> openReader(const fs::path& file, Format format, const ScanRequest& request) {
  switch (format) {
    case Format::Nrrd:
      return openItkScan(file, ItkFormat::Nrrd);
    case Format::MetaImage:
      return openItkScan(file, ItkFormat::MetaImage);
    case Format::Nifti:
      return openItkScan(file, ItkFormat::Nifti);
    case Format::Tiff:
      return openTiffScan(file);
    case Format::Vtk:
      return openItkScan(file, ItkFormat::Vtk);
    case Format::Vti:
      return openVtiScan(file, request.array);
    case Format::Dicom:
      return openDicomScan(file, request.series);
    case Format::Raw: {
      const std::optional<RawLayout> layout = request.raw ? request.raw : layoutOfName(file);
      if (!layout)
        fail(ErrorKind::Input, "'{}' has values without a header: say what they are with {}, or name it NAME_256x256x128_uint8.raw",
             file.string(), Parameter("raw", "WxHxD,TYPE"));
      return openRawScan(file, *layout);
    }
    case Format::Zarr:
      return openNgffScan(file, request);
    case Format::Mrc:
      break;
  }
  fail(ErrorKind::Input, "'{}' is an MRC map, which is not read: convert it to NRRD or NIfTI", file.string());
}

/// Fails for parts of the request that the file has no use for.
void checkRequest(const fs::path& file, Format format, const ScanRequest& request) {
  if (request.series && format != Format::Dicom)
    fail(ErrorKind::Usage, "{} chooses among the series of a DICOM folder, and '{}' is none", Parameter("series"), file.string());
  if (request.pyramidLevel && format != Format::Zarr)
    fail(ErrorKind::Usage, "{} chooses among the resolutions of OME-Zarr, and '{}' has one", Parameter("pyramid-level"), file.string());
}

/// The sides of the box that the header says, with the request's spacing.
void applySpacing(ScanHeader& header, const std::optional<glm::dvec3>& spacing) {
  if (!spacing) return;
  if (header.space == ScanSpace::File) header.space = ScanSpace::Millimetres;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = glm::length(header.indexToWorld[axis]);
    glm::dvec3 unit(0.0);
    unit[axis] = 1.0;
    const glm::dvec3 direction = length > 0.0 && std::isfinite(length) ? glm::dvec3(header.indexToWorld[axis]) / length : unit;
    header.indexToWorld[axis] = glm::dvec4(direction * (*spacing)[axis], 0.0);
  }
}

struct OpenedScan {
  std::unique_ptr<ScanReader> reader;
  ScanHeader header;
};

/// Runs `work`, and says of what a library throws which file it is about.
template <typename Work>
auto withFileErrors(const fs::path& file, const Work& work) {
  const CrashNote note(fmt::format("cannot read '{}': the file is damaged; copy or download it again", printable(file.string())));
  try {
    return work();
  } catch (const std::bad_alloc&) {
    fail(ErrorKind::OutOfMemory, "not enough memory to read '{}'; free some, or resample or crop the scan", file.string());
  } catch (const std::system_error& error) {
    fail(ErrorKind::Input, "cannot read '{}': {}", file.string(), error.code().message());
  }
}

OpenedScan openScan(const fs::path& file, const ScanRequest& request) {
  std::error_code error;
  const bool isFolder = fs::is_directory(file, error);
  if (!isFolder) checkInputFile("scan", file);
  const Format format = formatOf(file, request);
  checkRequest(file, format, request);
  OpenedScan opened{.reader = openReader(file, format, request), .header = {}};
  opened.header = opened.reader->header();
  opened.header.areColors |= opened.header.components > 1;
  // Those of VTK are arrays, which have names.
  if (opened.header.components > 1 && format != Format::Vti) describeColors(opened.header);
  const bool isSingle = opened.header.channels.empty() && format != Format::Vti && format != Format::Zarr && format != Format::Tiff;
  if (!request.array.empty() && isSingle)
    fail(ErrorKind::Usage, "{} chooses among several, and '{}' has one grid of values", Parameter("grid"), file.string());
  applySpacing(opened.header, request.spacing);
  const int step = request.timeStep.value_or(0);
  if (step >= opened.header.timeSteps)
    fail(ErrorKind::Usage, "{} is none of '{}', which has {} time step{}, counted from 0", Parameter("time-step", fmt::format("{}", step)),
         file.string(), opened.header.timeSteps, opened.header.timeSteps == 1 ? "" : "s");
  return opened;
}

/// The voxels that are read.
VoxelBox partOf(const ScanHeader& header) {
  return header.part.value_or(VoxelBox{.first = glm::ivec3(0), .last = header.dimensions - 1});
}

/// Fails before memory is taken.
void checkSize(const fs::path& file, const OpenedScan& opened, std::uint64_t maximumVoxels, std::size_t channels) {
  const VoxelBox part = partOf(opened.header);
  const glm::ivec3 size = part.last - part.first + 1;
  const std::uint64_t voxels = std::uint64_t(size.x) * std::uint64_t(size.y) * std::uint64_t(size.z);
  constexpr std::size_t kSums = 4;  // of channels: densities and colours
  const std::uint64_t bricks = voxels / ScalarBricks::kVoxels, sums = channels == 0 ? 0 : kSums;
  const std::uint64_t bytes =
      std::max<std::uint64_t>(channels, 1) * ScalarBricks::bytesOf(bricks, ScanVoxels::bytesOfVoxel(opened.header.type)) +
      sums * ScalarBricks::bytesOf(bricks) + opened.reader->bytesToRead();
  if (voxels > maximumVoxels)
    fail(ErrorKind::OutOfMemory,
         "'{}' is too large: its {} x {} x {} voxels are more than the {} that are possible here; resample or crop it", file.string(),
         size.x, size.y, size.z, maximumVoxels);
  if (bytes > machineMemoryBytes())
    fail(ErrorKind::OutOfMemory,
         "'{}' is too large: reading its {} x {} x {} voxels takes {} MiB, and this machine has {}; resample or crop it", file.string(),
         size.x, size.y, size.z, bytes >> 20, machineMemoryBytes() >> 20);
}

/// The scalars of the channels with these numbers; of channels that follow each other in every voxel in one pass.
std::vector<ScalarBricks> readChannels(const OpenedScan& opened, const ScanRequest& request, const std::vector<int>& numbers) {
  const VoxelBox box = partOf(opened.header);
  std::deque<ScanVoxels> voxels;
  const SampleType type = opened.reader->fillsBox() ? opened.header.type : SampleType::F32;
  for (std::size_t i = 0; i < numbers.size(); ++i) voxels.emplace_back(type, box.last - box.first + 1, box.first);
  ScanPart part{.timeStep = request.timeStep.value_or(0), .box = box};
  if (opened.header.components > 1) {
    const auto put = [&](const SampleBlock& block) {
      for (std::size_t i = 0; i < numbers.size(); ++i) voxels[i].put(block, numbers[i]);
    };
    opened.reader->read(part, put, request.progress);
  } else {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      part.channel = numbers[i];
      opened.reader->read(
          part, [&](const SampleBlock& block) { voxels[i].put(block); }, request.progress);
    }
  }
  std::vector<ScalarBricks> values;
  for (ScanVoxels& one : voxels) values.push_back(one.take());
  return values;
}

/// The volume of what is chosen.
Volume chosenVolume(const fs::path& file, const OpenedScan& opened, const ScanRequest& request, ChosenChannels chosen) {
  const ScanHeader& header = opened.header;
  const std::string name = fileNameOf(file);
  glm::dmat4 indexToWorld = header.indexToWorld;
  indexToWorld[3] = indexToWorld * glm::dvec4(glm::dvec3(partOf(header).first), 1.0);
  if (chosen.areColors) {
    Volume volume = volumeOfColors(readChannels(opened, request, chosen.numbers), header.type, indexToWorld, name);
    if (request.asColors) return volume;
    return volumeOfScalars(std::move(volume.scalars), indexToWorld, request.noData, name);
  }
  if (chosen.numbers.empty()) {
    const int channel = header.channels.empty() ? 0 : channelOf(file, header, request.array, Parameter("grid", request.array));
    const std::string array = header.channels.empty() ? header.array : request.array;
    return volumeOfScalars(std::move(readChannels(opened, request, {channel}).front()), indexToWorld, request.noData,
                           array.empty() ? name : name + " " + array, request.labels);
  }
  std::vector<ScalarBricks> values = readChannels(opened, request, chosen.numbers);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!chosen.styles[i].window) chosen.styles[i].window = windowAboveBackground(values[i]);
  return volumeOfChannels(std::move(values), indexToWorld, chosen.styles, name);
}

}  // namespace

bool areColors(int components, SampleType type) {
  return (components == 3 || components == 4) && (type == SampleType::U8 || type == SampleType::U16);
}

void checkComponents(const fs::path& file, int components, SampleType type) {
  if (components == 1 || areColors(components, type)) return;
  fail(ErrorKind::Input,
       "'{}' has {} numbers a voxel of type {}, and scans have one, or 3 or 4 of 8 or 16 bits, which are colours: write one of them, "
       "or their magnitude, into a file",
       file.string(), components, nameOf(type));
}

void checkEdges(const fs::path& file, const glm::i64vec3& dimensions) {
  constexpr std::int64_t kLongestEdge = 1 << 20;
  for (int axis = 0; axis < 3; ++axis)
    if (dimensions[axis] < 1 || dimensions[axis] > kLongestEdge)
      failDamaged(file, fmt::format("its header says {} x {} x {} voxels", dimensions.x, dimensions.y, dimensions.z));
}

void checkPayload(const fs::path& file, std::uint64_t bytes, std::uint64_t fileBytes, bool isCompressed) {
  constexpr std::uint64_t kMaxRatio = 1032;  // of zlib
  if (bytes <= fileBytes || (isCompressed && bytes / kMaxRatio <= fileBytes)) return;
  failDamaged(file, fmt::format("its header says {} bytes of values, and the file has {}", bytes, fileBytes));
}

bool isScanFile(const fs::path& file) {
  std::error_code error;
  return endingOf(file) != nullptr || fs::is_directory(file, error) || hasDicomSignature(file);
}

bool hasScanEnding(const fs::path& file) {
  return endingOf(file) != nullptr;
}

std::span<const std::string_view> scanEndings() {
  static const std::vector<std::string_view> endings = [] {
    std::vector<std::string_view> all;
    for (const Ending& one : kEndings)
      if (one.format != Format::Mrc) all.push_back(one.ending);
    return all;
  }();
  return endings;
}

std::string stemOf(const fs::path& file) {
  const Ending* const ending = endingOf(file);
  if (!ending) return (file.has_filename() ? file : file.parent_path()).stem().string();
  const std::string name = fileNameOf(file);
  return name.substr(0, name.size() - ending->ending.size());
}

ScanHeader readScanHeader(const fs::path& file, const ScanRequest& request) {
  return withFileErrors(file, [&] { return openScan(file, request).header; });
}

std::vector<ChannelStyle> scanChannels(const fs::path& file, const ScanRequest& request) {
  return withFileErrors(file, [&] {
    OpenedScan opened = openScan(file, request);
    return chosenChannels(file, opened.header, request).styles;
  });
}

Volume readScan(const fs::path& file, const ScanRequest& request) {
  return withFileErrors(file, [&] {
    OpenedScan opened = openScan(file, request);
    const ChosenChannels chosen = chosenChannels(file, opened.header, request);
    checkSize(file, opened, request.maximumVoxels, chosen.numbers.size());
    Volume volume = chosenVolume(file, opened, request, chosen);
    const ScanHeader& header = opened.header;
    volume.isPart = header.part.has_value();
    if (header.part) volume.indexOrigin = header.part->first;
    volume.remarks.insert(volume.remarks.begin(), header.remarks.begin(), header.remarks.end());
    volume.up = {0.0, 0.0, 1.0};
    volume.upReason = "it is a scan";
    if (header.space != ScanSpace::File) volume.lengthUnit = "mm";
    volume.valueUnit = header.valueUnit;
    return volume;
  });
}

}  // namespace freevoxels
