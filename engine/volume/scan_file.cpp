#include "engine/volume/scan_file.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <new>
#include <system_error>

#include "engine/core/crash_note.h"
#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/core/machine.h"
#include "engine/core/printable.h"
#include "engine/volume/histogram.h"
#include "engine/volume/scan_reader.h"
#include "engine/volume/volume_of_scalars.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

/// How a file is read. Unknown are those of formats that are refused.
enum class Format { Nrrd, MetaImage, Nifti, Tiff, Vtk, Vti, Dicom, Raw, Zarr, Unknown };

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
     {".raw", Format::Raw},           {".mrc", Format::Unknown}}};

/// "ct" of "scans/ct/".
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

std::unique_ptr<ScanReader> open(const fs::path& file, Format format, const ScanRequest& request) {
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
    case Format::Unknown:
      break;
  }
  fail(ErrorKind::Input, "'{}' is an MRC map, which is not read: convert it to NRRD or NIfTI", file.string());
}

/// Fails for parts of the request that the file has no use for.
void checkRequest(const fs::path& file, Format format, const ScanRequest& request) {
  if (request.series && format != Format::Dicom)
    fail(ErrorKind::Usage, "{} chooses among the series of a DICOM folder, and '{}' is none", Parameter("series"), file.string());
  const bool hasChannels = format == Format::Zarr || format == Format::Tiff;
  if (!request.array.empty() && format != Format::Vti && !hasChannels)
    fail(ErrorKind::Usage, "{} chooses among several, and '{}' has one grid of values", Parameter("grid"), file.string());
  if (request.pyramidLevel && format != Format::Zarr)
    fail(ErrorKind::Usage, "{} chooses among the resolutions of OME-Zarr, and '{}' has one", Parameter("pyramid-level"), file.string());
}

/// "0 'DAPI', 1 'GFP'"
std::string channelList(const ScanHeader& header) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < header.channels.size(); ++i)
    words.push_back(header.channels[i].name.empty() ? fmt::format("{}", i) : fmt::format("{} '{}'", i, printable(header.channels[i].name)));
  return fmt::format("{}", fmt::join(words, ", "));
}

/// The number of the channel with a name, or that has this number itself.
int channelOf(const fs::path& file, const ScanHeader& header, const std::string& name, const Parameter& asked) {
  const auto named = std::ranges::find(header.channels, name, &ScanChannel::name);
  if (named != header.channels.end()) return int(named - header.channels.begin());
  std::size_t number = 0;
  const char* const end = name.data() + name.size();
  const auto [stopped, error] = std::from_chars(name.data(), end, number);
  if (error == std::errc() && stopped == end && number < std::max<std::size_t>(header.channels.size(), 1)) return int(number);
  if (header.channels.empty()) fail(ErrorKind::Input, "{} is none of '{}', which has one channel, 0", asked, file.string());
  fail(ErrorKind::Input, "{} is none of the channels of '{}': {}", asked, file.string(), channelList(header));
}

/// Channels that are drawn together, and their numbers in the file.
struct ChosenChannels {
  std::vector<ChannelStyle> styles;
  std::vector<int> numbers;
};

/// Those that are asked for, or that the file shows, with the file's colours and windows where none are given. None where one is read
/// alone.
ChosenChannels chosenChannels(const fs::path& file, ScanHeader& header, const ScanRequest& request) {
  ChosenChannels chosen;
  if (!request.array.empty() || (request.channels.empty() && header.channels.empty())) return chosen;
  const auto add = [&](ChannelStyle style, int number) {
    if (!header.channels.empty()) {
      const ScanChannel& described = header.channels[std::size_t(number)];
      if (!style.color) style.color = described.color;
      if (!style.window) style.window = described.window;
    }
    chosen.styles.push_back(std::move(style));
    chosen.numbers.push_back(number);
  };
  for (const ChannelStyle& style : request.channels) add(style, channelOf(file, header, style.name, Parameter("channel", style.name)));
  if (!request.channels.empty()) return chosen;
  if (request.labels != nullptr)
    fail(ErrorKind::Usage, "'{}' has channels, and labels are of one: choose it with {}: {}", file.string(), Parameter("grid", "NAME"),
         channelList(header));
  const bool showsSome = std::ranges::any_of(header.channels, &ScanChannel::isShown);
  for (std::size_t i = 0; i < header.channels.size() && chosen.numbers.size() < kMostChannels; ++i)
    if (header.channels[i].isShown || !showsSome)
      add({.name = header.channels[i].name.empty() ? fmt::format("{}", i) : header.channels[i].name}, int(i));
  header.remarks.push_back(fmt::format("{} of its {} channels are drawn ({} chooses others, {} draws one as a scan)", chosen.numbers.size(),
                                       header.channels.size(), Parameter("channel"), Parameter("grid")));
  return chosen;
}

/// The sides of the box that the header says, with the request's spacing.
void space(ScanHeader& header, const std::optional<glm::dvec3>& spacing) {
  if (!spacing) return;
  header.inMillimetres = true;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = glm::length(header.indexToWorld[axis]);
    glm::dvec3 unit(0.0);
    unit[axis] = 1.0;
    const glm::dvec3 direction = length > 0.0 && std::isfinite(length) ? glm::dvec3(header.indexToWorld[axis]) / length : unit;
    header.indexToWorld[axis] = glm::dvec4(direction * (*spacing)[axis], 0.0);
  }
}

/// The window of a channel of which neither the file nor the user says one: from the end of the background, whose noise reaches as far
/// above the most frequent value as below it, to the value that one voxel in a thousand exceeds. Nothing where most voxels are above that.
std::optional<std::array<float, 2>> windowAboveBackground(const ScalarBricks& values) {
  constexpr int kBins = 4096;
  constexpr double kTail = 0.001, kMostAbove = 0.5;  // parts of the voxels
  Volume channel{.dimensions = values.dimensions(), .scalars = values};
  summariseValues(channel);
  if (!(channel.minimum < channel.maximum)) return std::nullopt;
  const Histogram histogram = histogramOf(channel, kBins);
  const auto binBelow = [&](double part) {
    double count = 0.0;
    int bin = 0;
    while (bin + 1 < kBins && count + double(histogram.counts[std::size_t(bin)]) < part * double(channel.activeVoxels))
      count += double(histogram.counts[std::size_t(bin++)]);
    return bin;
  };
  const int mode = int(std::ranges::max_element(histogram.counts) - histogram.counts.begin());
  const int begin = 2 * mode - std::min(binBelow(kTail), mode) + 1, end = binBelow(1.0 - kTail) + 1;
  if (begin >= end || binBelow(1.0 - kMostAbove) >= begin) return std::nullopt;
  const auto valueAt = [&](int bin) { return std::lerp(channel.minimum, channel.maximum, float(bin) / float(kBins)); };
  return std::array{valueAt(begin), valueAt(end)};
}

struct Opened {
  std::unique_ptr<ScanReader> reader;
  ScanHeader header;
};

/// Runs `work`, and says of what a library throws which file it is about.
template <typename Work>
auto guarded(const fs::path& file, const Work& work) {
  const CrashNote note(fmt::format("cannot read '{}': the file is damaged; copy or download it again", printable(file.string())));
  try {
    return work();
  } catch (const std::bad_alloc&) {
    fail(ErrorKind::OutOfMemory, "not enough memory to read '{}'; free some, or resample or crop the scan", file.string());
  } catch (const std::system_error& error) {
    fail(ErrorKind::Input, "cannot read '{}': {}", file.string(), error.code().message());
  }
}

Opened openScan(const fs::path& file, const ScanRequest& request) {
  std::error_code error;
  const bool isFolder = fs::is_directory(file, error);
  if (!isFolder) checkInputFile("scan", file);
  const Format format = formatOf(file, request);
  checkRequest(file, format, request);
  Opened opened{.reader = open(file, format, request), .header = {}};
  opened.header = opened.reader->header();
  space(opened.header, request.spacing);
  const int step = request.timeStep.value_or(0);
  if (step >= opened.header.timeSteps)
    fail(ErrorKind::Usage, "{} is none of '{}', which has {} time step{}, counted from 0", Parameter("time-step", fmt::format("{}", step)),
         file.string(), opened.header.timeSteps, opened.header.timeSteps == 1 ? "" : "s");
  return opened;
}

/// Fails before memory is taken.
void checkSize(const fs::path& file, const Opened& opened, std::uint64_t maximumVoxels, std::size_t channels) {
  const glm::ivec3 size = opened.header.dimensions;
  const std::uint64_t voxels = opened.header.samples();
  constexpr std::size_t kSums = 4;  // of channels: densities and colours
  const std::uint64_t boxes = channels == 0 ? 1 : channels + kSums;
  const std::uint64_t bytes = boxes * ScalarBricks::bytesOf(voxels / std::tuple_size_v<ScalarBricks::Brick>) + opened.reader->bytesToRead();
  if (voxels > maximumVoxels)
    fail(ErrorKind::OutOfMemory,
         "'{}' is too large: its {} x {} x {} voxels are more than the {} that are possible here; resample or crop it", file.string(),
         size.x, size.y, size.z, maximumVoxels);
  if (bytes > machineMemoryBytes())
    fail(ErrorKind::OutOfMemory,
         "'{}' is too large: reading its {} x {} x {} voxels takes {} MiB, and this machine has {}; resample or crop it", file.string(),
         size.x, size.y, size.z, bytes >> 20, machineMemoryBytes() >> 20);
}

}  // namespace

void checkEdges(const fs::path& file, const glm::i64vec3& dimensions) {
  constexpr std::int64_t kLongestEdge = 1 << 20;
  for (int axis = 0; axis < 3; ++axis)
    if (dimensions[axis] < 1 || dimensions[axis] > kLongestEdge)
      failDamaged(file, fmt::format("its header says {} x {} x {} voxels", dimensions.x, dimensions.y, dimensions.z));
}

void checkPayload(const fs::path& file, std::uint64_t bytes, std::uint64_t fileBytes, bool isCompressed) {
  constexpr std::uint64_t kLargestRatio = 1032;  // of zlib
  if (bytes <= fileBytes || (isCompressed && bytes / kLargestRatio <= fileBytes)) return;
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
      if (one.format != Format::Unknown) all.push_back(one.ending);
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
  return guarded(file, [&] { return openScan(file, request).header; });
}

std::vector<ChannelStyle> scanChannels(const fs::path& file, const ScanRequest& request) {
  return guarded(file, [&] {
    Opened opened = openScan(file, request);
    return chosenChannels(file, opened.header, request).styles;
  });
}

Volume readScan(const fs::path& file, const ScanRequest& request) {
  return guarded(file, [&] {
    Opened opened = openScan(file, request);
    ScanHeader& header = opened.header;
    ChosenChannels chosen = chosenChannels(file, header, request);
    checkSize(file, opened, request.maximumVoxels, chosen.numbers.size());
    const auto read = [&](int channel) {
      ScanVoxels voxels(header.dimensions);
      opened.reader->read(
          {.timeStep = request.timeStep.value_or(0), .channel = channel}, [&](const SampleBlock& block) { voxels.put(block); },
          request.progress);
      return voxels.take();
    };
    const std::string name = fileNameOf(file);
    Volume volume;
    if (chosen.numbers.empty()) {
      const int channel = header.channels.empty() ? 0 : channelOf(file, header, request.array, Parameter("grid", request.array));
      const std::string array = header.channels.empty() ? header.array : request.array;
      volume =
          volumeOfScalars(read(channel), header.indexToWorld, request.noData, array.empty() ? name : name + " " + array, request.labels);
    } else {
      std::vector<ScalarBricks> values;
      for (std::size_t i = 0; i < chosen.numbers.size(); ++i) {
        values.push_back(read(chosen.numbers[i]));
        if (!chosen.styles[i].window) chosen.styles[i].window = windowAboveBackground(values[i]);
      }
      volume = volumeOfChannels(std::move(values), header.indexToWorld, chosen.styles, name);
    }
    volume.remarks.insert(volume.remarks.begin(), header.remarks.begin(), header.remarks.end());
    volume.up = {0.0, 0.0, 1.0};
    volume.upReason = "it is a scan";
    return volume;
  });
}

}  // namespace freevoxels
