// VTK's XML images (.vti), by https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html: appended raw and base64, inline base64
// and text, each plain or compressed by zlib.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "engine/core/random_access_file.h"
#include "engine/volume/scan_reader.h"
#include "engine/volume/vti_bytes.h"

namespace freevoxels {

namespace {

using Bytes = std::vector<std::byte>;

struct Box {
  glm::ivec3 first{0}, extent{0};
};

struct ArrayType {
  std::string_view name;
  SampleType type;
};
constexpr std::array<ArrayType, 10> kTypes{{{"UInt8", SampleType::U8},
                                            {"Int8", SampleType::I8},
                                            {"UInt16", SampleType::U16},
                                            {"Int16", SampleType::I16},
                                            {"UInt32", SampleType::U32},
                                            {"Int32", SampleType::I32},
                                            {"UInt64", SampleType::U64},
                                            {"Int64", SampleType::I64},
                                            {"Float32", SampleType::F32},
                                            {"Float64", SampleType::F64}}};

template <typename Number>
std::vector<Number> numbersOf(const char* text) {
  std::istringstream stream(text);
  std::vector<Number> numbers;
  for (Number number; stream >> number;) numbers.push_back(number);
  return numbers;
}

/// A part of the image, with the array that is read.
struct Piece {
  Box box;  ///< of samples, in the whole
  pugi::xml_node array;
};

class VtiScan : public ScanReader {
 public:
  VtiScan(const std::filesystem::path& file, const std::string& array) : path_(file), file_(file) {
    load();
    const pugi::xml_node root = document_.child("VTKFile"), image = root.child("ImageData");
    if (!image) fail(ErrorKind::Input, "'{}' is no VTK image: it has no element ImageData; save image data in ParaView", path_.string());
    isSwapped_ = (std::string_view(root.attribute("byte_order").as_string("LittleEndian")) == "BigEndian") !=
                 (std::endian::native == std::endian::big);
    hasLongSizes_ = std::string_view(root.attribute("header_type").as_string("UInt32")) == "UInt64";
    const std::string_view compressor = root.attribute("compressor").as_string();
    isCompressed_ = !compressor.empty();
    if (isCompressed_ && compressor != "vtkZLibDataCompressor")
      fail(ErrorKind::Input, "'{}' is compressed by {}, and zlib alone is read: save it with zlib or without compression", path_.string(),
           compressor);
    placeImage(image);
    takePieces(image, array);
    takeHeader();
  }

  void read(const ScanPart&, const SampleSink& sink, const Progress& progress) override {
    for (const Piece& piece : pieces_) {
      if (progress) progress("reading the scan", 0.0);
      const std::string_view format = piece.array.attribute("format").as_string();
      const std::uint64_t size = std::uint64_t(piece.box.extent.x) * std::uint64_t(piece.box.extent.y) * std::uint64_t(piece.box.extent.z) *
                                 header_.bytesOfVoxel();
      const bool isText = format == "ascii";
      const Bytes values = isText ? textValues(piece, size) : binaryValues(piece, size);
      sink({.samples = values.data(),
            .type = header_.type,
            .components = header_.components,
            .isSwapped = !isText && isSwapped_,
            .first = piece.box.first,
            .extent = piece.box.extent});
    }
  }

  bool fillsBox() const override { return pieces_.size() == 1; }
  std::uint64_t bytesToRead() const override { return header_.samples() * header_.bytesOfVoxel(); }

 private:
  /// Parses the XML; of appended values, which need be none, what is in front of them.
  void load() {
    constexpr std::size_t kStep = std::size_t(1) << 20;
    std::size_t end = std::string::npos, start = std::string::npos;
    while (text_.size() < file_.bytes() && end == std::string::npos) {
      const std::size_t before = text_.size();
      text_.resize(std::min<std::size_t>(before + kStep, file_.bytes()));
      if (file_.readAt(before, std::as_writable_bytes(std::span(text_.data() + before, text_.size() - before))) != text_.size() - before)
        failDamaged(path_, "it ends too early");
      if (start == std::string::npos) start = text_.find("<AppendedData", before < 16 ? 0 : before - 16);
      if (start != std::string::npos) end = text_.find('_', std::min(text_.find('>', start), text_.size()));
    }
    if (start != std::string::npos && end == std::string::npos) failDamaged(path_, "it ends in front of its values");
    if (end != std::string::npos) {
      appended_ = end + 1;
      text_.resize(text_.find('>', start) + 1);
      text_ += "</AppendedData></VTKFile>";
    }
    const pugi::xml_parse_result result = document_.load_buffer_inplace(text_.data(), text_.size());
    if (!result) failDamaged(path_, fmt::format("its XML has an error at byte {}: {}", result.offset, result.description()));
    appendedIsBase64_ =
        std::string_view(document_.child("VTKFile").child("AppendedData").attribute("encoding").as_string("base64")) == "base64";
  }

  /// From the text "x0 x1 y0 y1 z0 z1" of points.
  Box boxOf(const char* text) const {
    const std::vector<std::int64_t> n = numbersOf<std::int64_t>(text);
    constexpr std::int64_t kFarthest = 1 << 28;
    if (n.size() != 6 || std::ranges::any_of(n, [&](std::int64_t v) { return v < -kFarthest || v > kFarthest; }))
      failDamaged(path_, fmt::format("it has an extent of '{}'", text));
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
      box.first[axis] = int(n[std::size_t(2 * axis)]);
      box.extent[axis] = int(n[std::size_t(2 * axis + 1)] - n[std::size_t(2 * axis)] + 1);
    }
    return box;
  }

  void placeImage(const pugi::xml_node& image) {
    whole_ = boxOf(image.attribute("WholeExtent").as_string());
    const auto spacing = numbersOf<double>(image.attribute("Spacing").as_string("1 1 1"));
    const auto origin = numbersOf<double>(image.attribute("Origin").as_string("0 0 0"));
    const auto direction = numbersOf<double>(image.attribute("Direction").as_string("1 0 0 0 1 0 0 0 1"));
    if (spacing.size() != 3 || origin.size() != 3 || direction.size() != 9)
      failDamaged(path_, "its spacing, origin or direction is no numbers");
    for (std::size_t column = 0; column < 3; ++column)
      for (std::size_t row = 0; row < 3; ++row) header_.indexToWorld[int(column)][int(row)] = direction[3 * row + column] * spacing[column];
    header_.indexToWorld[3] = {origin[0], origin[1], origin[2], 1.0};
  }

  static int componentsOf(const pugi::xml_node& array) { return array.attribute("NumberOfComponents").as_int(1); }

  static bool hasColors(const pugi::xml_node& array) {
    const auto type = std::ranges::find(kTypes, std::string_view(array.attribute("type").as_string()), &ArrayType::name);
    return type != kTypes.end() && areColors(componentsOf(array), type->type);
  }

  /// The array of the name, the scalars, the only one of single numbers, or else of colours; of points, or of cells.
  pugi::xml_node arrayOf(const pugi::xml_node& data, const std::string& wanted) const {
    const std::string name = !wanted.empty() ? wanted : data.attribute("Scalars").as_string();
    if (const pugi::xml_node found = data.find_child_by_attribute("DataArray", "Name", name.c_str()); found && !name.empty()) return found;
    if (!wanted.empty()) return {};
    std::vector<pugi::xml_node> single, colors;
    for (const pugi::xml_node& array : data.children("DataArray")) {
      if (componentsOf(array) == 1) single.push_back(array);
      if (hasColors(array)) colors.push_back(array);
    }
    const std::vector<pugi::xml_node>& usable = single.empty() ? colors : single;
    return usable.size() == 1 ? usable.front() : pugi::xml_node();
  }

  std::string namesOf(const pugi::xml_node& piece) const {
    std::string names;
    for (const char* data : {"PointData", "CellData"})
      for (const pugi::xml_node& array : piece.child(data).children("DataArray"))
        names += fmt::format("{}{}", names.empty() ? "" : ", ", array.attribute("Name").as_string("?"));
    return names.empty() ? "none" : names;
  }

  void takePieces(const pugi::xml_node& image, const std::string& wanted) {
    for (const pugi::xml_node& node : image.children("Piece")) {
      Piece piece{.box = boxOf(node.attribute("Extent").as_string()), .array = arrayOf(node.child("PointData"), wanted)};
      if (!piece.array) {
        piece.array = arrayOf(node.child("CellData"), wanted);
        isOfCells_ = true;
      }
      if (!piece.array)
        fail(ErrorKind::Input, "'{}' has {} array '{}': choose one with {}: {}", path_.string(), wanted.empty() ? "no one" : "no",
             wanted.empty() ? "of scalars" : wanted, Parameter("grid", "NAME"), namesOf(node));
      piece.box.first -= whole_.first;
      piece.box.extent -= isOfCells_ ? 1 : 0;
      pieces_.push_back(piece);
    }
    if (pieces_.empty()) failDamaged(path_, "it has no piece");
    if (!isOfCells_) return;
    whole_.extent -= 1;
    header_.indexToWorld[3] = header_.indexToWorld * glm::dvec4(0.5, 0.5, 0.5, 1.0);
  }

  void takeHeader() {
    checkEdges(path_, whole_.extent);
    header_.format = "VTK image";
    header_.dimensions = whole_.extent;
    header_.indexToWorld[3] = header_.indexToWorld * glm::dvec4(glm::dvec3(whole_.first), 1.0);
    const pugi::xml_node first = pieces_.front().array;
    header_.array = first.attribute("Name").as_string();
    const std::string_view type = first.attribute("type").as_string();
    const auto known = std::ranges::find(kTypes, type, &ArrayType::name);
    if (known == kTypes.end()) failDamaged(path_, fmt::format("its array '{}' has the type '{}'", header_.array, type));
    header_.type = known->type;
    header_.components = componentsOf(first);
    for (const Piece& piece : pieces_) {
      if (piece.array.attribute("type").as_string() != type) failDamaged(path_, "its pieces have different types");
      if (componentsOf(piece.array) != 1 && !hasColors(piece.array))
        fail(ErrorKind::Input,
             "array '{}' of '{}' has {} numbers a voxel, and scans have one, or 3 or 4 of 8 or 16 bits, which are colours: choose "
             "another with {}: {}",
             header_.array, path_.string(), componentsOf(piece.array), Parameter("grid", "NAME"), namesOf(piece.array.parent().parent()));
      if (componentsOf(piece.array) != header_.components) failDamaged(path_, "its pieces have different numbers of components");
      checkEdges(path_, piece.box.extent);
      if (glm::any(glm::lessThan(piece.box.first, glm::ivec3(0))) ||
          glm::any(glm::greaterThan(piece.box.first + piece.box.extent, whole_.extent)))
        failDamaged(path_, "a piece is not in its extent");
    }
    checkPayload(path_, header_.samples() * (pieces_.size() == 1 ? header_.bytesOfVoxel() : 0), file_.bytes(),
                 isCompressed_ || first.attribute("format").as_string() == std::string_view("ascii"));
  }

  std::unique_ptr<ByteStream> streamOf(const Piece& piece) const {
    const std::string_view format = piece.array.attribute("format").as_string();
    if (format != "appended") return std::make_unique<Base64Bytes>(std::make_unique<TextBytes>(piece.array.child_value()));
    if (appended_ == 0) failDamaged(path_, "it has no appended values");
    auto bytes = std::make_unique<FileBytes>(file_, appended_ + piece.array.attribute("offset").as_ullong());
    if (!appendedIsBase64_) return bytes;
    return std::make_unique<Base64Bytes>(std::move(bytes));
  }

  void mustRead(ByteStream& stream, std::span<std::byte> bytes) const {
    if (!stream.read(bytes)) failDamaged(path_, "its values end too early");
  }

  /// A size in a header of values.
  std::uint64_t readSize(ByteStream& stream) const {
    std::array<std::byte, 8> bytes{};
    const std::size_t count = hasLongSizes_ ? 8 : 4;
    mustRead(stream, std::span(bytes).first(count));
    if (isSwapped_) std::reverse(bytes.begin(), bytes.begin() + std::ptrdiff_t(count));
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data() + (std::endian::native == std::endian::big ? 8 - count : 0), count);
    return size;
  }

  void checkBytes(std::uint64_t there, std::uint64_t needed) const {
    if (there != needed) failDamaged(path_, fmt::format("its extent takes {} bytes of values, and it has {}", needed, there));
  }

  Bytes binaryValues(const Piece& piece, std::uint64_t size) const {
    const std::unique_ptr<ByteStream> stream = streamOf(piece);
    stream->beginPart();
    const std::uint64_t first = readSize(*stream);
    if (!isCompressed_) {
      checkBytes(first, size);
      Bytes values(size);
      mustRead(*stream, values);
      return values;
    }
    const std::uint64_t block = readSize(*stream), last = readSize(*stream);
    const std::uint64_t full = first - (last > 0 ? 1 : 0);
    if (first == 0 || first > size || block > size || last > block) failDamaged(path_, "its blocks are not what its extent takes");
    checkBytes(full * block + last, size);
    std::vector<std::uint64_t> packed(first);
    for (std::uint64_t& one : packed) one = readSize(*stream);
    stream->beginPart();
    Bytes values(size), input;
    std::uint64_t at = 0;
    for (std::uint64_t i = 0; i < first; ++i) {
      uLongf unpacked = i < full ? block : last;
      if (packed[i] > compressBound(unpacked)) failDamaged(path_, "a block of its values is too long");
      input.resize(packed[i]);
      mustRead(*stream, input);
      const uLongf expected = unpacked;
      if (uncompress(reinterpret_cast<Bytef*>(values.data() + at), &unpacked, reinterpret_cast<const Bytef*>(input.data()), input.size()) !=
              Z_OK ||
          unpacked != expected)
        failDamaged(path_, "a block of its values cannot be decompressed");
      at += unpacked;
    }
    return values;
  }

  Bytes textValues(const Piece& piece, std::uint64_t size) const {
    Bytes values(size);
    const char* at = piece.array.child_value();
    withSampleType(header_.type, [&](auto typed) {
      using Value = decltype(typed);
      const char* const end = at + std::strlen(at);
      for (std::size_t i = 0; i < size; i += sizeof(Value)) {
        while (at != end && std::strchr(" \n\r\t", *at)) ++at;
        Value value{};
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc()) failDamaged(path_, "its values end too early, or are no numbers");
        std::memcpy(values.data() + i, &value, sizeof(Value));
        at = next;
      }
    });
    return values;
  }

  const std::filesystem::path path_;
  const RandomAccessFile file_;
  std::string text_;  ///< of the document
  pugi::xml_document document_;
  std::uint64_t appended_ = 0;  ///< where appended values begin in the file; 0 without any
  bool appendedIsBase64_ = false, isSwapped_ = false, hasLongSizes_ = false, isCompressed_ = false;
  bool isOfCells_ = false;  ///< whether the values are of cells, not of points
  Box whole_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::unique_ptr<ScanReader> openVtiScan(const std::filesystem::path& file, const std::string& array) {
  return std::make_unique<VtiScan>(file, array);
}

}  // namespace freevoxels
