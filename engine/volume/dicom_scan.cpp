// DICOM series: ITK reads the values of each slice.
#include <gdcmTrace.h>
#include <itkGDCMImageIO.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/volume/dicom_tags.h"
#include "engine/volume/itk_common.h"
#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

/// What orders a file among those of its series.
struct Slice {
  fs::path file;
  std::string series, description;
  bool isImage = false;
  int frames = 1;
  double instance = 0.0;
  std::optional<glm::dvec3> position, right, down;
  double along = 0.0;  ///< position along the normal of the slices, in millimetres
};
using Slices = std::vector<Slice>;

constexpr DicomTag kModality = 0x00080060, kDescription = 0x0008103e, kSeries = 0x0020000e, kInstance = 0x00200013, kPosition = 0x00200032,
                   kOrientation = 0x00200037, kFrames = 0x00280008, kRows = 0x00280010, kColumns = 0x00280011, kBits = 0x00280100,
                   kPixelData = 0x7fe00010;

/// The `count` numbers of a text with backslashes between them; empty for any other.
std::vector<double> numbersIn(const std::string& text, std::size_t count) {
  std::vector<double> numbers;
  const char* at = text.c_str();
  for (char* end = nullptr; numbers.size() < count; at = end + (*end == '\\')) {
    const double number = std::strtod(at, &end);
    if (end == at || !std::isfinite(number)) return {};
    numbers.push_back(number);
  }
  return numbers;
}

constexpr std::uint64_t kAnyBytes = std::uint64_t(1) << 62;  // of compressed values

/// Nothing for a file that is not DICOM. Fails for an image that is cut, or lacks what GDCM relies on.
std::optional<Slice> readTags(const fs::path& file) {
  const std::optional<DicomTags> tags = DicomTags::read(file);
  if (!tags) return std::nullopt;
  Slice slice{.file = file, .series = tags->text(kSeries), .description = printable(tags->text(kDescription)), .isImage = tags->has(kRows)};
  for (const auto& [tag, name] : {std::pair(kColumns, "columns (0028,0011)"), std::pair(kBits, "bits of a value (0028,0100)"),
                                  std::pair(kPixelData, "values (7fe0,0010)")})
    if (slice.isImage && !tags->has(tag)) failDamaged(file, fmt::format("it does not have its {}", name));
  if (const auto n = numbersIn(tags->text(kFrames), 1); !n.empty()) slice.frames = int(std::clamp(n[0], 1.0, 1e6));
  const std::uint64_t needed = std::uint64_t(tags->number(kRows).value_or(0)) * tags->number(kColumns).value_or(0) *
                               (tags->number(kBits).value_or(0) / 8u) * std::uint64_t(slice.frames);
  if (slice.isImage && tags->pixelBytes().value_or(kAnyBytes) < needed)
    failDamaged(file, fmt::format("its size takes {} bytes of values, and it has {}", needed, *tags->pixelBytes()));
  if (const auto n = numbersIn(tags->text(kInstance), 1); !n.empty()) slice.instance = n[0];
  if (const auto n = numbersIn(tags->text(kPosition), 3); !n.empty()) slice.position = glm::dvec3(n[0], n[1], n[2]);
  if (const auto n = numbersIn(tags->text(kOrientation), 6); !n.empty()) {
    slice.right = glm::dvec3(n[0], n[1], n[2]);
    slice.down = glm::dvec3(n[3], n[4], n[5]);
  }
  return slice;
}

/// The images of a folder by their series.
std::map<std::string, Slices> seriesIn(const fs::path& folder) {
  std::set<fs::path> files;  // in the order of their names
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file()) files.insert(entry.path());
  std::map<std::string, Slices> all;
  for (const fs::path& file : files)
    if (std::optional<Slice> slice = readTags(file); slice && slice->isImage) all[slice->series].push_back(std::move(*slice));
  return all;
}

std::string listOf(const std::map<std::string, Slices>& all) {
  constexpr std::size_t kMostListed = 20;
  std::string list;
  std::size_t listed = 0;
  for (const auto& [uid, slices] : all) {
    if (listed++ == kMostListed) return list + ", ...";
    const std::string& name = slices.front().description;
    list += fmt::format("{}{} ({}{} slice{})", list.empty() ? "" : ", ", uid, name.empty() ? "" : name + ", ", slices.size(),
                        slices.size() == 1 ? "" : "s");
  }
  return list;
}

Slices chooseSeries(const fs::path& file, const std::optional<std::string>& series) {
  std::error_code error;
  const bool isFolder = fs::is_directory(file, error);
  std::optional<Slice> named;
  if (!isFolder) {
    named = readTags(file);
    if (!named) failDamaged(file, "it is no DICOM file");
    if (!named->isImage) fail(ErrorKind::Input, "'{}' holds no image: name a file of a series, or its folder", file.string());
    if (named->frames > 1 || named->series.empty()) return {*named};
  }
  const fs::path parent = file.has_parent_path() ? file.parent_path() : ".";
  std::map<std::string, Slices> all = seriesIn(isFolder ? file : parent);
  if (all.empty())
    fail(ErrorKind::Input, "'{}' is a folder without DICOM files; name a file in it, or the folder of a DICOM series", file.string());
  if (!series && isFolder && all.size() > 1)
    fail(ErrorKind::Input, "'{}' has {} series; choose one with {}: {}", file.string(), all.size(), Parameter("series", "UID"),
         listOf(all));
  const auto found = series ? all.find(*series) : isFolder ? all.begin() : all.find(named->series);
  if (found == all.end()) fail(ErrorKind::Input, "'{}' has no series {}; it has {}", file.string(), series.value_or(""), listOf(all));
  return found->second;
}

/// Fails where slices do not tell where they are, or are not parallel; orders them along their normal.
void order(Slices& slices) {
  constexpr double kParallel = 1e-3;
  for (const Slice& slice : slices)
    if (!slice.position || !slice.right)
      fail(ErrorKind::Input, "'{}' does not say where its slice is: it has no {}; leave the file out of the series", slice.file.string(),
           slice.position ? "orientation (0020,0037)" : "position (0020,0032)");
  const Slice& first = slices.front();
  const glm::dvec3 normal = glm::cross(*first.right, *first.down);
  for (Slice& slice : slices) {
    if (glm::length(*slice.right - *first.right) > kParallel || glm::length(*slice.down - *first.down) > kParallel)
      fail(ErrorKind::Input, "the slices '{}' and '{}' of the series are not parallel: divide it into folders", first.file.string(),
           slice.file.string());
    slice.along = glm::dot(*slice.position, normal);
  }
  std::ranges::stable_sort(slices,
                           [](const Slice& a, const Slice& b) { return std::pair(a.along, a.instance) < std::pair(b.along, b.instance); });
}

/// How many slices are at each place. Fails where that differs.
int stepsOf(const Slices& slices) {
  constexpr double kSame = 1e-3;  // millimetres
  std::vector<std::size_t> counts;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    if (i == 0 || slices[i].along - slices[i - 1].along > kSame) counts.push_back(0);
    ++counts.back();
    if (counts.size() > 1 && counts.back() > counts.front())
      fail(ErrorKind::Input, "'{}' is at the place of another slice of the series: leave one of them out", slices[i].file.string());
  }
  const auto less = std::ranges::find_if(counts, [&](std::size_t count) { return count != counts.front(); });
  if (less != counts.end())
    fail(ErrorKind::Input, "the series of '{}' has {} slices at one place and {} at another: {} are missing, or too many",
         slices.front().file.string(), counts.front(), *less, counts.front() - *less);
  return int(counts.front());
}

/// Fails where a slice is missing.
void checkGaps(const Slices& slices, std::size_t steps) {
  constexpr double kEven = 0.02, kJitter = 2e-3;  // of the spacing; millimetres, which positions are rounded to
  std::vector<double> gaps;
  for (std::size_t i = steps; i < slices.size(); i += steps) gaps.push_back(slices[i].along - slices[i - steps].along);
  if (gaps.size() < 2) return;
  std::vector<double> sorted = gaps;
  std::ranges::nth_element(sorted, sorted.begin() + std::ptrdiff_t(sorted.size() / 2));
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (std::abs(gaps[i] - usual) <= kEven * usual + kJitter) continue;
    const double missing = std::round(gaps[i] / usual) - 1.0;
    const fs::path &before = slices[i * steps].file, &after = slices[(i + 1) * steps].file;
    const std::string what = missing >= 1.0 ? fmt::format("{} slice{} missing", missing, missing == 1.0 ? " is" : "s are")
                                            : std::string("slices are spaced unevenly");
    fail(ErrorKind::Input,
         "{} between '{}' and '{}': they are {:.4g} mm apart, and others {:.4g} mm; add the slices, or resample the series", what,
         before.string(), after.filename().string(), gaps[i], usual);
  }
}

class DicomScan : public ScanReader {
 public:
  DicomScan(const fs::path& file, Slices slices) : path_(file), slices_(std::move(slices)) {
    if (slices_.size() > 1) {
      order(slices_);
      header_.timeSteps = stepsOf(slices_);
      checkGaps(slices_, std::size_t(header_.timeSteps));
    }
    const int timeSteps = header_.timeSteps, places = int(slices_.size()) / timeSteps;
    const auto io = open(slices_.front().file);
    header_ = headerOf(slices_.front().file, *io);
    checkPayload(slices_.front().file, header_.samples(), fs::file_size(slices_.front().file), true);
    header_.timeSteps = timeSteps;
    header_.space = ScanSpace::Patient;
    header_.format = places == 1 ? "DICOM" : fmt::format("DICOM series of {} slices", places);
    header_.type = sampleTypeOf(io->GetInternalComponentType()).value_or(SampleType::U16);
    if (io->GetRescaleSlope() != 1.0 || io->GetRescaleIntercept() != 0.0)
      header_.rescale = glm::dvec2(io->GetRescaleSlope(), io->GetRescaleIntercept());
    if (const auto tags = DicomTags::read(slices_.front().file); tags && tags->text(kModality) == "CT") header_.valueUnit = "HU";
    if (places == 1) return;
    if (header_.dimensions.z != 1)
      fail(ErrorKind::Input, "'{}' has several files of several slices each: name one of the files", path_.string());
    header_.dimensions.z = places;
    // The slices of a tilted gantry are not above each other.
    header_.indexToWorld[2] = glm::dvec4((*slices_.back().position - *slices_.front().position) / double(places - 1), 0.0);
  }

  void read(const ScanPart& part, const SampleSink& sink, const Progress& progress) override {
    const auto steps = std::size_t(header_.timeSteps);
    glm::ivec3 extent = header_.dimensions;
    if (slices_.size() > steps) extent.z = 1;
    for (std::size_t i = std::size_t(part.timeStep), z = 0; i < slices_.size(); i += steps, ++z) {
      if (progress) progress("reading the scan", double(z) / header_.dimensions.z);
      readFile(slices_[i].file, {.first = {0, 0, int(z)}, .extent = extent}, sink);
    }
  }

  std::uint64_t bytesToRead() const override {
    const std::uint64_t samples = header_.samples() / std::uint64_t(slices_.size() > 1 ? header_.dimensions.z : 1);
    return 2 * samples * sizeof(double) * std::uint64_t(header_.components);
  }

 private:
  static itk::GDCMImageIO::Pointer open(const fs::path& file) {
    const auto io = itk::GDCMImageIO::New();
    quietItk(file, [&] {
      gdcm::Trace::WarningOff();
      gdcm::Trace::ErrorOff();
      io->SetFileName(file.string());
      if (!io->CanReadFile(file.string().c_str())) failDamaged(file, "it is no DICOM file");
      io->ReadImageInformation();
    });
    return io;
  }

  void readFile(const fs::path& file, SampleBlock block, const SampleSink& sink) const {
    const auto io = open(file);
    const ScanHeader header = headerOf(file, *io);
    const glm::ivec3 size = header.dimensions;
    if (header.components != header_.components)
      fail(ErrorKind::Input, "'{}' has {} numbers a pixel, and the first slice of the series {}: leave it out", file.string(),
           header.components, header_.components);
    if (size != block.extent)
      fail(ErrorKind::Input, "'{}' has {} x {} pixels, and the first slice of the series {} x {}: leave it out", file.string(), size.x,
           size.y, block.extent.x, block.extent.y);
    checkPayload(file, header.samples(), fs::file_size(file), true);
    wantAll(*io);
    const auto buffer = std::make_unique_for_overwrite<std::byte[]>(header.samples() * header.bytesOfVoxel());
    quietItk(file, [&] { io->Read(buffer.get()); });
    block.samples = buffer.get();
    block.type = header.type;
    block.components = header.components;
    sink(block);
  }

  const fs::path path_;
  Slices slices_;  ///< by place, and at each place by time
};

}  // namespace

std::unique_ptr<ScanReader> openDicomScan(const fs::path& file, const std::optional<std::string>& series) {
  return std::make_unique<DicomScan>(file, chooseSeries(file, series));
}

}  // namespace freevoxels
