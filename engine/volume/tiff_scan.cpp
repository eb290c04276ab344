// Stacks of TIFF, by libtiff: the pages of a file, with channels and time where ImageJ or OME describes them, and the files of a folder.
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <system_error>

#include "engine/core/random_access_file.h"
#include "engine/volume/scan_reader.h"
#include "engine/volume/tiff_description.h"

namespace freevoxels {

namespace {

namespace tiff_fs = std::filesystem;

constexpr std::uint64_t kMaxPart = std::uint64_t(1) << 31;  ///< bytes that libtiff may allocate at once

constexpr std::uint32_t kImageJByteCounts = 50838, kImageJMetadata = 50839;  ///< tags

/// A file of which libtiff prints nothing; its first error is kept.
class TiffFile {
 public:
  explicit TiffFile(const tiff_fs::path& file) : path_(file) {
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(), &TIFFOpenOptionsFree);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), tmsize_t(kMaxPart));
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), &TiffFile::keep, this);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), &TiffFile::ignore, nullptr);
    tiff_.reset(TIFFOpenExt(file.c_str(), "rm", options.get()));
    if (!tiff_) failDamaged(path_, error_.empty() ? "it is no TIFF file" : error_);
  }
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  TIFF* get() const { return tiff_.get(); }
  const tiff_fs::path& path() const { return path_; }
  /// Fails where libtiff has found an error.
  void check() const {
    if (!error_.empty()) failDamaged(path_, error_);
  }
  template <typename Value>
  Value tag(std::uint32_t number, Value without) const {
    Value value = without;
    return TIFFGetFieldDefaulted(tiff_.get(), number, &value) == 1 ? value : without;
  }
  /// The values of a tag that libtiff does not know; none where it is not there, or is of other types.
  template <typename Value>
  std::span<const Value> list(std::uint32_t number, std::initializer_list<int> types) const {
    const TIFFField* const field = TIFFFindField(tiff_.get(), number, TIFF_ANY);
    if (field == nullptr || TIFFFieldReadCount(field) != TIFF_VARIABLE2 || TIFFFieldPassCount(field) == 0) return {};
    const int type = TIFFFieldDataType(field);  // of a damaged file any number, which a TIFFDataType must not hold
    if (std::ranges::find(types, type) == types.end()) return {};
    std::uint32_t count = 0;
    const Value* values = nullptr;
    if (TIFFGetField(tiff_.get(), number, &count, &values) != 1 || values == nullptr) return {};
    return {values, count};
  }

 private:
  struct Close {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
  };
  static int keep(TIFF*, void* self, const char*, const char* format, va_list values) {
    char text[200];
    std::vsnprintf(text, sizeof(text), format, values);
    std::string& error = static_cast<TiffFile*>(self)->error_;
    if (error.empty()) error = text;
    return 1;
  }
  static int ignore(TIFF*, void*, const char*, const char*, va_list) { return 1; }

  const tiff_fs::path path_;
  std::string error_;
  std::unique_ptr<TIFF, Close> tiff_;
};

/// What all pages of a stack have in common.
struct TiffPageForm {
  glm::ivec2 size{0};
  SampleType type = SampleType::U8;
  int components = 1;       ///< 3 or 4 of colours
  bool isPlanar = false;    ///< whether the values of each component are behind those of another
  bool isInverted = false;  ///< whether 0 is white
  bool isPremultiplied = false;  ///< whether colours have been multiplied by the opacity that follows them

  std::uint64_t bytes() const { return std::uint64_t(size.x) * std::uint64_t(size.y) * bytesOfPixel(); }
  std::uint64_t bytesOfPixel() const { return bytesOf(type) * std::uint64_t(components); }
  bool operator==(const TiffPageForm&) const = default;
};

std::optional<SampleType> tiffType(int bits, int format) {
  if (format == SAMPLEFORMAT_IEEEFP)
    return bits == 32 ? std::optional(SampleType::F32) : bits == 64 ? std::optional(SampleType::F64) : std::nullopt;
  if (format != SAMPLEFORMAT_UINT && format != SAMPLEFORMAT_INT && format != SAMPLEFORMAT_VOID) return std::nullopt;
  return sampleTypeOf(fmt::format("{}{}", format == SAMPLEFORMAT_INT ? "int" : "uint", bits));
}

/// How many numbers a pixel of the current page has. Those of colours that JPEG has packed become red, green and blue.
int componentsOf(const TiffFile& file, SampleType type) {
  const int components = file.tag<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
  if (components == 1) return 1;
  checkComponents(file.path(), components, type);
  const auto photometric = file.tag<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  const bool isPacked =
      photometric == PHOTOMETRIC_YCBCR && file.tag<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_JPEG;
  if (isPacked) TIFFSetField(file.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  if (photometric != PHOTOMETRIC_RGB && !isPacked)
    fail(ErrorKind::Input, "'{}' has {} numbers a pixel that are not red, green and blue: write them as RGB, or each in pages of its own",
         file.path().string(), components);
  return components;
}

/// Whether the fourth number of a pixel of the current page is an opacity by which its colour has been multiplied.
bool hasAssociatedOpacity(const TiffFile& file) {
  std::uint16_t count = 0;
  const std::uint16_t* kinds = nullptr;
  return TIFFGetField(file.get(), TIFFTAG_EXTRASAMPLES, &count, &kinds) == 1 && count == 1 && kinds[0] == EXTRASAMPLE_ASSOCALPHA;
}

/// Divides the colours of pixels by their opacity.
template <typename Value>
void unpremultiply(std::span<std::byte> pixels) {
  constexpr std::size_t kComponents = 4;
  constexpr std::uint32_t kLargest = std::numeric_limits<Value>::max();
  std::array<Value, kComponents> pixel;
  for (; pixels.size() >= sizeof(pixel); pixels = pixels.subspan(sizeof(pixel))) {
    std::memcpy(pixel.data(), pixels.data(), sizeof(pixel));
    const std::uint32_t opacity = pixel.back();
    if (opacity == 0) continue;
    for (std::size_t c = 0; c + 1 < kComponents; ++c)
      pixel[c] = Value(std::min((std::uint32_t(pixel[c]) * kLargest + opacity / 2) / opacity, kLargest));
    std::memcpy(pixels.data(), pixel.data(), sizeof(pixel));
  }
}

/// The form of the current page. Fails for a page that is not of a scan.
TiffPageForm formOf(const TiffFile& file) {
  const auto width = file.tag<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0), height = file.tag<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
  checkEdges(file.path(), {std::int64_t(width), std::int64_t(height), 1});
  const int bits = file.tag<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1),
            format = file.tag<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  const std::optional<SampleType> type = tiffType(bits, format);
  if (!type)
    fail(ErrorKind::Input,
         "'{}' has values of {} bits of a type that no scan has: convert them to whole numbers of 8 to 64 bits or floats of "
         "32 or 64",
         file.path().string(), bits);
  TiffPageForm form{.size = {int(width), int(height)}, .type = *type, .components = componentsOf(file, *type)};
  form.isPlanar = form.components > 1 && file.tag<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;
  form.isInverted = file.tag<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_MINISWHITE &&
                    format == SAMPLEFORMAT_UINT && bits <= 16;
  form.isPremultiplied = form.components == 4 && hasAssociatedOpacity(file);
  return form;
}

/// Reads the tiles of a plane of the current page, all pixels of which `form` describes.
void readTiles(const TiffFile& file, const TiffPageForm& form, int plane, std::span<std::byte> values) {
  const glm::ivec2 tile(file.tag<std::uint32_t>(TIFFTAG_TILEWIDTH, 0), file.tag<std::uint32_t>(TIFFTAG_TILELENGTH, 0));
  const tmsize_t bytes = TIFFTileSize(file.get()), row = TIFFTileRowSize(file.get());
  const std::uint64_t pixel = form.bytesOfPixel();
  if (tile.x < 1 || tile.y < 1 || bytes < 1 || std::uint64_t(bytes) > kMaxPart || std::uint64_t(row) < std::uint64_t(tile.x) * pixel ||
      std::uint64_t(bytes) / std::uint64_t(row) < std::uint64_t(tile.y))
    failDamaged(file.path(), "its tiles are too large");
  std::vector<std::byte> buffer(static_cast<std::size_t>(bytes));
  for (int y = 0; y < form.size.y; y += tile.y)
    for (int x = 0; x < form.size.x; x += tile.x) {
      const std::uint32_t number = TIFFComputeTile(file.get(), std::uint32_t(x), std::uint32_t(y), 0, std::uint16_t(plane));
      if (TIFFReadEncodedTile(file.get(), number, buffer.data(), bytes) != bytes) failDamaged(file.path(), "a tile of it ends too early");
      const std::size_t count = std::size_t(std::min(tile.x, form.size.x - x)) * pixel;
      for (int line = 0; line < std::min(tile.y, form.size.y - y); ++line)
        std::copy_n(buffer.begin() + std::ptrdiff_t(row) * line, count,
                    values.begin() + std::ptrdiff_t((std::uint64_t(y + line) * std::uint64_t(form.size.x) + std::uint64_t(x)) * pixel));
    }
}

/// The same of strips.
void readStrips(const TiffFile& file, const TiffPageForm& form, int plane, std::span<std::byte> values) {
  const std::uint64_t row = std::uint64_t(form.size.x) * form.bytesOfPixel();
  const auto rows = std::min<std::uint64_t>(file.tag<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, 1), std::uint64_t(form.size.y));
  if (rows < 1) failDamaged(file.path(), "its strips have no rows");
  for (std::uint64_t y = 0; y < std::uint64_t(form.size.y); y += rows) {
    const std::span<std::byte> part = values.subspan(y * row, std::min(rows, std::uint64_t(form.size.y) - y) * row);
    const std::uint32_t strip = TIFFComputeStrip(file.get(), std::uint32_t(y), std::uint16_t(plane));
    if (TIFFReadEncodedStrip(file.get(), strip, part.data(), tmsize_t(part.size())) != tmsize_t(part.size())) {
      file.check();
      failDamaged(file.path(), "a strip of it ends too early");
    }
  }
}

/// Reads one plane of the current page.
void readPlaneOf(const TiffFile& file, const TiffPageForm& form, int plane, std::span<std::byte> values) {
  if (TIFFIsTiled(file.get()) != 0)
    readTiles(file, form, plane, values);
  else
    readStrips(file, form, plane, values);
  file.check();
}

/// Reads the planes of components, which then follow each other in every pixel.
void readPlanes(const TiffFile& file, const TiffPageForm& form, std::span<std::byte> values) {
  TiffPageForm single = form;
  single.components = 1;
  std::vector<std::byte> plane(single.bytes());
  const std::size_t value = bytesOf(form.type);
  for (int c = 0; c < form.components; ++c) {
    readPlaneOf(file, single, c, plane);
    for (std::size_t from = 0, to = std::size_t(c) * value; from < plane.size(); from += value, to += form.bytesOfPixel())
      std::copy_n(plane.begin() + std::ptrdiff_t(from), value, values.begin() + std::ptrdiff_t(to));
  }
}

/// "slice_9.tif" before "slice_10.tif".
bool comesBefore(const tiff_fs::path& a, const tiff_fs::path& b) {
  const auto padded = [](const tiff_fs::path& file) {
    constexpr std::size_t kDigits = 12;
    std::string result, digits;
    for (const char c : file.filename().string() + "/") {
      if (std::isdigit(static_cast<unsigned char>(c)) != 0) {
        digits += c;
        continue;
      }
      if (!digits.empty()) result += std::string(kDigits - std::min(digits.size(), kDigits), '0') + digits;
      digits.clear();
      result += c;
    }
    return result;
  };
  const std::string first = padded(a), second = padded(b);
  return first == second ? a < b : first < second;
}

std::vector<tiff_fs::path> filesOf(const tiff_fs::path& file) {
  if (!tiff_fs::is_directory(file)) return {file};
  std::vector<tiff_fs::path> files;
  for (const tiff_fs::directory_entry& entry : tiff_fs::directory_iterator(file)) {
    std::string ending = entry.path().extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    if (ending == ".tif" || ending == ".tiff") files.push_back(entry.path());
  }
  std::ranges::sort(files, comesBefore);
  return files;
}

class TiffScan : public ScanReader {
 public:
  explicit TiffScan(const tiff_fs::path& file) : files_(filesOf(file)), path_(files_.size() == 1 ? files_.front() : file) {
    const TiffFile first(files_.front());
    form_ = formOf(first);
    description_.format = "TIFF";
    const std::string text = first.tag<const char*>(TIFFTAG_IMAGEDESCRIPTION, "");
    const bool isOneFile = files_.size() == 1;
    if (isOneFile)
      if (auto described = imageJDescription(path_, text)) {
        description_ = *described;
        takeImageJLooks(first.list<std::byte>(kImageJMetadata, {TIFF_BYTE, TIFF_UNDEFINED}),
                        first.list<std::uint32_t>(kImageJByteCounts, {TIFF_LONG}), description_);
      }
    if (isOneFile)
      if (auto described = omeDescription(path_, text, form_.components)) description_ = *described;
    if (form_.components > 1 && description_.channels > 1)
      fail(ErrorKind::Input, "'{}' has {} channels of colours, and one is read: write them into files of their own", path_.string(),
           description_.channels);
    takePlace(first);
    listPages(first);
    header_.format = isOneFile ? description_.format : fmt::format("TIFF in {} files", files_.size());
    header_.type = form_.type;
    header_.components = form_.components;
    header_.dimensions = {form_.size, isOneFile ? description_.slices : int(files_.size())};
    header_.timeSteps = description_.frames;
    if (description_.channels > 1)
      header_.channels =
          description_.described.empty() ? std::vector<ScanChannel>(std::size_t(description_.channels)) : description_.described;
    checkEdges(path_, header_.dimensions);
  }

  void read(const ScanPart& part, const SampleSink& sink, const Progress& progress) override {
    std::vector<std::byte> values(form_.bytes());
    std::optional<TiffFile> file;
    for (int z = 0; z < header_.dimensions.z; ++z) {
      if (progress) progress("reading the scan", double(z) / header_.dimensions.z);
      bool isSwapped = false;
      if (files_.size() > 1) {
        readPage(TiffFile(files_[std::size_t(z)]), values);
      } else {
        if (!file) file.emplace(path_);
        isSwapped = readPlane(*file, description_.planeAt(part.channel, z, part.timeStep), values);
      }
      SampleBlock block{.samples = values.data(),
                        .type = form_.type,
                        .components = form_.components,
                        .isSwapped = isSwapped,
                        .first = {0, 0, z},
                        .extent = {form_.size, 1}};
      if (form_.isInverted) block.slope = -1.0;
      if (form_.isInverted) block.intercept = form_.type == SampleType::U8 ? 255.0 : 65535.0;
      sink(block);
    }
  }

  std::uint64_t bytesToRead() const override { return 3 * form_.bytes(); }

 private:
  /// Where the pages are in the file, and whether they are all that the description says.
  void listPages(const TiffFile& file) {
    constexpr std::size_t kMaxPages = std::size_t(1) << 24;
    if (files_.size() > 1) return;
    do {
      if ((file.tag<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0) & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) != 0) continue;
      if (pages_.size() >= kMaxPages) failDamaged(path_, "it has too many pages");
      pages_.push_back(TIFFCurrentDirOffset(file.get()));
    } while (TIFFReadDirectory(file.get()) == 1);
    file.check();
    if (pages_.empty()) failDamaged(path_, "it has no page of full size");
    if (description_.format == "TIFF") description_.slices = int(pages_.size());
    const std::uint64_t planes = description_.planes(), bytes = form_.bytes();
    if (bytes > (std::uint64_t(1) << 62) / planes) failDamaged(path_, "its pages are too large");
    TIFFSetSubDirectory(file.get(), pages_.front());
    constexpr std::uint64_t kBetterThanZlib = 64;  // what LZW, Zstandard and others may make smaller than that
    const bool isCompressed = file.tag<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) != COMPRESSION_NONE;
    checkPayload(path_, planes * bytes / (isCompressed ? kBetterThanZlib : 1), tiff_fs::file_size(path_), isCompressed);
    if (pages_.size() == 1 && planes > 1 && !isCompressed && !form_.isPlanar && description_.pages.empty()) {
      takeValuesBehindFirst(file, planes * bytes);
    } else if (description_.pages.empty() && planes > pages_.size()) {
      failDamaged(path_, fmt::format("its description says {} planes, and it has {} pages", planes, pages_.size()));
    }
  }

  /// ImageJ writes one page of files of more than 4 GiB, behind whose values are those of the others.
  void takeValuesBehindFirst(const TiffFile& file, std::uint64_t bytes) {
    behind_ = TIFFGetStrileOffset(file.get(), 0);
    const std::uint64_t there = tiff_fs::file_size(path_);
    if (behind_ == 0 || behind_ > there || bytes > there - behind_) failDamaged(path_, "it ends before its last image");
    isSwapped_ = TIFFIsByteSwapped(file.get()) != 0;
    values_ = std::make_unique<RandomAccessFile>(path_);
  }

  void takePlace(const TiffFile& file) {
    constexpr double kInch = 25.4, kCentimetre = 10.0;
    const auto unit = file.tag<std::uint16_t>(TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
    const bool isPlain = description_.format == "TIFF";
    bool hasUnit = description_.isInMillimetres;
    const double length = isPlain ? (unit == RESUNIT_INCH         ? kInch
                                     : unit == RESUNIT_CENTIMETER ? kCentimetre
                                                                  : 1.0)
                                  : description_.unit.value_or(1.0);
    if (!description_.distance[1]) description_.distance[1] = description_.distance[0];
    glm::dvec3 distance(1.0);
    for (const auto& [axis, tag] : {std::pair(0, TIFFTAG_XRESOLUTION), std::pair(1, TIFFTAG_YRESOLUTION)}) {
      const double resolution = file.tag<float>(std::uint32_t(tag), 0.0f);
      const bool isKnown = std::isfinite(resolution) && resolution > 0.0 && (!isPlain || unit != RESUNIT_NONE);
      distance[axis] = description_.distance[std::size_t(axis)].value_or(isKnown ? length / resolution : 1.0);
      hasUnit |= isPlain && isKnown && unit != RESUNIT_NONE;
    }
    if (hasUnit) header_.space = ScanSpace::Millimetres;
    distance.z = description_.distance[2].value_or(distance.x);
    for (int axis = 0; axis < 3; ++axis) header_.indexToWorld[axis][axis] = distance[axis];
  }

  /// Reads the current page.
  void readPage(const TiffFile& file, std::span<std::byte> values) const {
    if (formOf(file) != form_) failDamaged(file.path(), "its pages differ in size or type");
    if (form_.isPlanar)
      readPlanes(file, form_, values);
    else
      readPlaneOf(file, form_, 0, values);
    if (form_.isPremultiplied && form_.type == SampleType::U8) unpremultiply<std::uint8_t>(values);
    if (form_.isPremultiplied && form_.type == SampleType::U16) unpremultiply<std::uint16_t>(values);
  }

  /// Whether the bytes of the values are in the other order.
  bool readPlane(const TiffFile& file, std::uint64_t plane, std::span<std::byte> values) const {
    if (values_) {
      if (values_->readAt(behind_ + plane * form_.bytes(), values) != values.size()) failDamaged(path_, "it ends too early");
      return isSwapped_;
    }
    const int page = description_.pages.empty() ? int(plane) : description_.pages[plane];
    if (page < 0 || std::size_t(page) >= pages_.size())
      failDamaged(path_, fmt::format("its description has no page for plane {}, or one that is not there", plane));
    if (TIFFSetSubDirectory(file.get(), pages_[std::size_t(page)]) != 1) failDamaged(path_, "a page of it cannot be found");
    readPage(file, values);
    return false;
  }

  const std::vector<tiff_fs::path> files_;
  const tiff_fs::path path_;
  TiffPageForm form_;
  TiffDescription description_;
  std::vector<std::uint64_t> pages_;  ///< where they are in the file
  std::unique_ptr<RandomAccessFile> values_;
  std::uint64_t behind_ = 0;  ///< where the values are of a file of one page
  bool isSwapped_ = false;
};

}  // namespace

std::unique_ptr<ScanReader> openTiffScan(const tiff_fs::path& file) {
  return std::make_unique<TiffScan>(file);
}

}  // namespace freevoxels
