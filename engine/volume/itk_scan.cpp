// Scans that ITK reads, of one file each (and its detached data). ITK's ImageIO classes are used alone, without factories and images.
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkVTKImageIO.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "engine/volume/itk_common.h"
#include "engine/volume/nifti_values.h"
#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

itk::ImageIOBase::Pointer readerOf(ItkFormat format) {
  switch (format) {
    case ItkFormat::Nrrd:
      return itk::NrrdImageIO::New().GetPointer();
    case ItkFormat::MetaImage:
      return itk::MetaImageIO::New().GetPointer();
    case ItkFormat::Nifti:
      return itk::NiftiImageIO::New().GetPointer();
    case ItkFormat::Vtk:
      break;
  }
  return itk::VTKImageIO::New().GetPointer();
}

const char* nameOf(ItkFormat format) {
  switch (format) {
    case ItkFormat::Nrrd:
      return "NRRD";
    case ItkFormat::MetaImage:
      return "MetaImage";
    case ItkFormat::Nifti:
      return "NIfTI";
    case ItkFormat::Vtk:
      break;
  }
  return "VTK";
}

/// Of NIfTI.
constexpr int kRgbOfNifti = 128, kRgbaOfNifti = 2304;

/// Nothing for types of vectors and complex numbers, and of more than 64 bits.
std::optional<SampleType> niftiType(int code) {
  switch (code) {
    case 2:
    case kRgbOfNifti:
    case kRgbaOfNifti:
      return SampleType::U8;
    case 4:
      return SampleType::I16;
    case 8:
      return SampleType::I32;
    case 16:
      return SampleType::F32;
    case 64:
      return SampleType::F64;
    case 256:
      return SampleType::I8;
    case 512:
      return SampleType::U16;
    case 768:
      return SampleType::U32;
    case 1024:
      return SampleType::I64;
    case 1280:
      return SampleType::U64;
    default:
      return std::nullopt;
  }
}

/// The first bytes of a file, unpacked where it is compressed.
std::string startOf(const std::filesystem::path& file, std::size_t most) {
  std::string start(most, '\0');
  const gzFile stream = gzopen(file.c_str(), "rb");
  const int got = stream ? gzread(stream, start.data(), unsigned(most)) : 0;
  if (stream) gzclose(stream);
  start.resize(std::size_t(std::max(got, 0)));
  return start;
}

/// Where the values of a file are, as far as that can be told.
struct Payload {
  static constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t bytes = kUnknown;
  bool isCompressed = false;
};

/// MetaIO prints what it misses, so that it is looked for before.
Payload checkMetaHeader(const std::filesystem::path& file) {
  constexpr std::size_t kLongest = std::size_t(1) << 16;
  std::istringstream lines(startOf(file, kLongest));
  std::map<std::string, std::string> values;
  for (std::string line; !values.contains("ElementDataFile") && std::getline(lines, line);) {
    const std::size_t sign = std::min(line.find('='), line.size());
    std::istringstream key(line.substr(0, sign));
    std::string name, value;
    key >> name;
    std::istringstream rest(line.substr(std::min(sign + 1, line.size())));
    std::getline(rest >> std::ws, value);
    values[name] = value;
  }
  for (const char* needed : {"NDims", "DimSize", "ElementType", "ElementDataFile"})
    if (values[needed].empty()) failDamaged(file, fmt::format("its header has no {}", needed));
  if (!values["ElementType"].starts_with("MET_")) failDamaged(file, "its ElementType is none of MetaImage");
  std::istringstream sizes(values["DimSize"]);
  const auto given = std::distance(std::istream_iterator<std::int64_t>(sizes), std::istream_iterator<std::int64_t>());
  if (std::to_string(given) != values["NDims"])
    failDamaged(file, fmt::format("its DimSize has {} numbers, and its NDims is {}", given, values["NDims"]));
  Payload payload{.isCompressed = values["CompressedData"].starts_with('T') || values["CompressedData"].starts_with('1')};
  std::string where = values["ElementDataFile"];
  while (!where.empty() && std::isspace(static_cast<unsigned char>(where.back())) != 0) where.pop_back();
  if (where == "LOCAL" || where == "Local" || where == "local")
    payload.bytes = std::filesystem::file_size(file) - std::uint64_t(std::max<std::streamoff>(lines.tellg(), 0));
  else if (where.find_first_of(" %") == std::string::npos && where != "LIST")
    payload.bytes = std::filesystem::file_size(file.parent_path() / where);  // a missing file is an error
  const bool isText = values["BinaryData"].starts_with('F');
  if (isText) payload.bytes = Payload::kUnknown;
  return payload;
}

/// Likewise the library of NIfTI. Fails for values that are neither single numbers nor colours as well.
void checkNiftiHeader(const std::filesystem::path& file) {
  constexpr std::size_t kBytes = 348, kType = 70;
  const std::string start = startOf(file, kBytes);
  if (start.size() < kBytes) failDamaged(file, "it ends in its header");
  const bool isSwapped = start[0] == 0;
  const int type = std::uint8_t(start[kType + (isSwapped ? 1 : 0)]) | std::uint8_t(start[kType + (isSwapped ? 0 : 1)]) << 8;
  if (!niftiType(type))
    fail(ErrorKind::Input,
         "'{}' has values of NIfTI's type {}, and scans have one whole number or float of up to 64 bits a voxel, or colours of 8 bits: "
         "convert it",
         file.string(), type);
}

class ItkScan : public ScanReader {
 public:
  ItkScan(const std::filesystem::path& file, ItkFormat format) : path_(file), format_(format), io_(readerOf(format)) {
    Payload payload{.bytes = std::filesystem::file_size(path_), .isCompressed = format_ != ItkFormat::Vtk && !hasEnding(".nii")};
    if (hasEnding(".nhdr")) payload.bytes = Payload::kUnknown;
    if (format_ == ItkFormat::MetaImage) payload = checkMetaHeader(path_);
    if (format_ == ItkFormat::Nifti) checkNiftiHeader(path_);
    quietItk(path_, [&] {
      io_->SetFileName(path_.string());
      if (!io_->CanReadFile(path_.string().c_str())) failDamaged(path_, fmt::format("it is no {} file", nameOf(format)));
      io_->ReadImageInformation();
    });
    header_ = headerOf(path_, *io_);
    header_.format = nameOf(format);
    takeSpace();
    takeTimeSteps();
    describeNifti();
    if (payload.bytes != Payload::kUnknown)
      checkPayload(path_, header_.samples() * std::uint64_t(header_.timeSteps) * header_.bytesOfVoxel(), payload.bytes,
                   payload.isCompressed);
  }

  void read(const ScanPart& part, const SampleSink& sink, const Progress& progress) override {
    if (format_ == ItkFormat::Nifti) return readNiftiValues(path_, header_, part.timeStep, sink, progress);
    if (progress) progress("reading the scan", 0.0);
    wantAll(*io_);
    const auto buffer = std::make_unique_for_overwrite<std::byte[]>(bytesToRead());
    readWhole({buffer.get(), bytesToRead()});
    const std::uint64_t step = header_.samples() * header_.bytesOfVoxel() * std::uint64_t(part.timeStep);
    sink({.samples = buffer.get() + step,
          .type = header_.type,
          .components = header_.components,
          .first = glm::ivec3(0),
          .extent = header_.dimensions});
  }

  std::uint64_t bytesToRead() const override {
    if (format_ == ItkFormat::Nifti) return bytesToReadNifti(header_);
    return header_.samples() * header_.bytesOfVoxel() * std::uint64_t(header_.timeSteps);
  }

 private:
  bool hasEnding(std::string_view ending) const {
    std::string name = path_.filename().string();
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return name.ends_with(ending);
  }

  /// Reads all values. ITK says nothing of some files that end too early, and leaves the last values as they were: these differ then
  /// where they were set otherwise before.
  void readWhole(std::span<std::byte> bytes) const {
    const std::span<std::byte> last = bytes.last(bytesOf(header_.type));
    const auto readOver = [&](std::byte before) {
      std::ranges::fill(last, before);
      quietItk(path_, [&] { io_->Read(bytes.data()); });
      return std::vector<std::byte>(last.begin(), last.end());
    };
    constexpr std::byte kOne{0xa5}, kOther{0x5a};
    const std::vector<std::byte> once = readOver(kOne);
    if (std::ranges::find(once, kOne) != once.end() && readOver(kOther) != once) failDamaged(path_, "its values end too early");
  }

  /// NRRD says whether its axes are those of a patient; MetaImage and NIfTI have no others.
  void takeSpace() {
    if (format_ == ItkFormat::Vtk) return;
    const std::string space = textIn(io_->GetMetaDataDictionary(), "NRRD_space");
    const bool isOfPatient = space.find("posterior") != std::string::npos || space.find("anterior") != std::string::npos;
    header_.space = format_ != ItkFormat::Nrrd || isOfPatient ? ScanSpace::Patient : ScanSpace::File;
  }

  /// A fourth axis is time; of others there must be one step.
  void takeTimeSteps() {
    constexpr unsigned kTime = 3;
    constexpr itk::SizeValueType kMaxSteps = 1 << 20;
    for (unsigned axis = kTime; axis < io_->GetNumberOfDimensions(); ++axis) {
      const itk::SizeValueType steps = io_->GetDimensions(axis);
      if (axis > kTime && steps != 1)
        fail(ErrorKind::Input, "'{}' has {} dimensions, and scans have three, or four with time: take a part of it", path_.string(),
             io_->GetNumberOfDimensions());
      if (steps < 1 || steps > kMaxSteps) failDamaged(path_, fmt::format("its header says {} time steps", steps));
      if (axis == kTime) header_.timeSteps = int(steps);
    }
  }

  /// What ITK has applied to the values of NIfTI.
  void describeNifti() {
    const auto* const nifti = dynamic_cast<const itk::NiftiImageIO*>(io_.GetPointer());
    if (!nifti) return;
    const auto& dictionary = io_->GetMetaDataDictionary();
    const double slope = numberIn(dictionary, "scl_slope").value_or(0.0), intercept = numberIn(dictionary, "scl_inter").value_or(0.0);
    if (slope != 0.0 && (slope != 1.0 || intercept != 0.0)) header_.rescale = glm::dvec2(slope, intercept);
    const int code = int(numberIn(dictionary, "datatype").value_or(0.0));
    header_.type = niftiType(code).value_or(header_.type);
    // Other vectors of NIfTI have all values of one component behind those of another.
    if (header_.components > 1 && code != kRgbOfNifti && code != kRgbaOfNifti)
      fail(ErrorKind::Input, "'{}' has vectors, and scans have single numbers or colours: write their magnitude into a file",
           path_.string());
    if (header_.components > 1) header_.rescale.reset();
  }

  const std::filesystem::path path_;
  const ItkFormat format_;
  const itk::ImageIOBase::Pointer io_;
};

}  // namespace

std::unique_ptr<ScanReader> openItkScan(const std::filesystem::path& file, ItkFormat format) {
  return std::make_unique<ItkScan>(file, format);
}

}  // namespace freevoxels
