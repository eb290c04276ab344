// File layout: OpenVDB's io/Archive.cc and io/GridDescriptor.cc, format versions 222 (2013) and later.
#include "engine/volume/vdb_header.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <span>
#include <string_view>
#include <system_error>

#include "engine/core/error.h"
#include "engine/core/nearest_name.h"
#include "engine/volume/vdb_reader.h"
#include "engine/volume/vdb_tree_check.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMagic = 0x56444220;  // "VDB "
constexpr std::uint32_t kOldestFormat = 222;
constexpr std::size_t kUuidLength = 36;

/// The names in the folder of a file, as far as it can be read.
std::vector<std::string> namesBeside(const fs::path& file) {
  std::vector<std::string> names;
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    names.push_back(entry->path().filename().string());
  std::ranges::sort(names);  // so that the first of equally near names is chosen, whatever the order of the folder
  return names;
}

void checkRegularFile(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) {
    if (status.type() == fs::file_type::none)
      fail(ErrorKind::Input, "cannot open '{}': {}; check its path and permissions", file.string(),
           error.message());
    const std::string meant = suggestion(file.filename().string(), namesBeside(file));
    fail(ErrorKind::Input, "there is no file '{}'{}", file.string(), meant.empty() ? "; check the name" : meant);
  }
  if (fs::is_directory(status)) fail(ErrorKind::Input, "'{}' is a folder; name an OpenVDB file in it", file.string());
  if (!fs::is_regular_file(status))
    fail(ErrorKind::Input, "'{}' is not a regular file; copy its contents into a .vdb file first",
         file.string());
}

/// Guesses the kind of a file that is not an OpenVDB file.
std::string_view guessKind(const fs::path& file) {
  char bytes[512];
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes, sizeof(bytes));
  const std::string_view head(bytes, std::size_t(stream.gcount()));
  if (head.empty()) return "it is empty";
  const bool isText = std::none_of(head.begin(), head.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == 127 || (byte < 32 && c != '\n' && c != '\r' && c != '\t' && c != '\f');
  });
  return isText ? "it is text" : "it does not begin with OpenVDB's signature";
}

void checkSignature(const fs::path& file, VdbReader& reader) {
  if (reader.size() < sizeof(kMagic) || reader.read<std::int64_t>() != kMagic) {
    fail(ErrorKind::Input, "'{}' is not an OpenVDB file: {}; give a .vdb file that OpenVDB has written",
         file.string(), guessKind(file));
  }
}

struct TypeSize {
  std::string_view type;
  std::uint32_t bytes;
};

/// OpenVDB reads these metadata types with their own size, whatever size the file states.
constexpr TypeSize kMetadataTypes[] = {{"bool", 1},   {"float", 4},  {"double", 8}, {"int32", 4},
                                       {"int64", 8},  {"vec2i", 8},  {"vec2s", 8},  {"vec2d", 16},
                                       {"vec3i", 12}, {"vec3s", 12}, {"vec3d", 24}, {"vec4i", 16},
                                       {"vec4s", 16}, {"vec4d", 32}, {"mat4s", 64}, {"mat4d", 128}};

/// Bytes that OpenVDB writes for a transform after the name of its type. Those of frustums vary.
constexpr TypeSize kTransformTypes[] = {{"AffineMap", 128},         {"UnitaryMap", 128},
                                        {"ScaleMap", 120},          {"UniformScaleMap", 120},
                                        {"ScaleTranslateMap", 144}, {"UniformScaleTranslateMap", 144},
                                        {"TranslationMap", 24}};

const TypeSize* find(std::span<const TypeSize> types, const std::string& type) {
  const auto found = std::ranges::find(types, type, &TypeSize::type);
  return found == types.end() ? nullptr : &*found;
}

/// Skips the masks and sizes of leaves that are stored for delayed loading. OpenVDB allocates by their
/// counts.
void skipDelayedLoading(VdbReader& reader, std::uint32_t bytes) {
  constexpr std::uint64_t kMinLeaf = 64;
  constexpr std::uint64_t kMinPacked = 128;  // OpenVDB pads shorter data before compressing it
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  if (bytes == 0) return;
  const std::uint64_t end = reader.position() + bytes;
  const std::uint64_t leaves = reader.read<std::uint32_t>();
  if (leaves > reader.size() / kMinLeaf) reader.failDamaged("its metadata counts {} leaves", leaves);
  for (const std::size_t bytesOfOne : {sizeof(std::int8_t), sizeof(std::int64_t)}) {
    const auto packed = reader.read<std::uint32_t>();
    const bool isLeftOut = bytesOfOne > 1 && packed == kNone;  // only sizes can be left out
    if (packed == 0)
      reader.skip(leaves * bytesOfOne);
    else if (!isLeftOut)
      skipBlosc(reader, packed, std::max(leaves * bytesOfOne, kMinPacked));
  }
  if (reader.position() > end) reader.failDamaged("its metadata is longer than its size");
  reader.seek(end);
}

/// Skips metadata; returns whether they say that values are stored as half.
bool skipMetadata(VdbReader& reader) {
  bool savedAsHalf = false;
  const auto count = reader.read<std::int32_t>();
  if (count < 0) reader.failDamaged("it counts {} metadata entries", count);
  for (std::int32_t i = 0; i < count; ++i) {
    const std::string name = reader.readString();
    const std::string type = reader.readString();
    const auto bytes = reader.read<std::uint32_t>();
    if (const TypeSize* known = find(kMetadataTypes, type); known && known->bytes != bytes)
      reader.failDamaged("its metadata give {} bytes to a {}", bytes, type);
    if (type == "__delayedload")
      skipDelayedLoading(reader, bytes);
    else if (name == "is_saved_as_half_float" && type == "bool")
      savedAsHalf = reader.read<char>() != 0;
    else
      reader.skip(bytes);
  }
  return savedAsHalf;
}

/// Skips a transform; returns false if its end is unknown.
bool skipTransform(VdbReader& reader) {
  const TypeSize* known = find(kTransformTypes, reader.readString());
  if (known) reader.skip(known->bytes);
  return known;
}

/// Reads the grid's descriptor, without the positions that follow.
VdbHeader::Grid readDescriptor(VdbReader& reader) {
  constexpr std::string_view kHalfSuffix = "_HalfFloat";
  VdbHeader::Grid grid;
  grid.uniqueName = reader.readString();
  grid.type = reader.readString();
  if (grid.type.ends_with(kHalfSuffix)) {
    grid.type.resize(grid.type.size() - kHalfSuffix.size());
    grid.savedAsHalf = true;
  }
  grid.parentName = reader.readString();
  return grid;
}

/// Reads the grid up to its tree.
void readGridStart(VdbReader& reader, VdbHeader::Grid& grid) {
  grid.compression = reader.read<std::uint32_t>();
  grid.valuesAreHalf = skipMetadata(reader);
  if (skipTransform(reader)) grid.treeStart = reader.position();
}

VdbHeader::Grid readGridEntry(VdbReader& reader) {
  VdbHeader::Grid grid = readDescriptor(reader);
  const auto gridStart = reader.read<std::int64_t>();
  const auto blockStart = reader.read<std::int64_t>();
  const auto end = reader.read<std::int64_t>();
  // A grid that shares the tree of another one (an instance) has no blocks of its own.
  const bool sharesTree = !grid.parentName.empty() && blockStart == 0;
  const bool blocksAreOutside = !sharesTree && (blockStart < gridStart || end < blockStart);
  if (gridStart < std::int64_t(reader.position()) || end < gridStart || blocksAreOutside)
    reader.failDamaged("its grids are not where its header says");
  reader.seek(std::uint64_t(end));  // checked first, so that a truncated file is not called damaged
  reader.seek(std::uint64_t(gridStart));
  grid.start = std::uint64_t(gridStart);
  grid.end = std::uint64_t(end);
  readGridStart(reader, grid);
  reader.seek(std::uint64_t(end));
  return grid;
}

/// Checks grids that follow each other, as long as the end of each is known.
void checkStreamedGrids(VdbReader& reader, std::int32_t count, const Progress& progress) {
  bool canContinue = true;
  for (std::int32_t i = 0; i < count && canContinue; ++i) {
    VdbHeader::Grid grid = readDescriptor(reader);
    reader.skip(3 * sizeof(std::int64_t));  // positions, which are not known in a stream
    readGridStart(reader, grid);
    canContinue = grid.parentName.empty() ? checkVdbTree(reader, grid, progress) : grid.treeStart != 0;
  }
}

}  // namespace

VdbHeader readVdbHeader(const std::filesystem::path& file, const Progress& progress) {
  checkRegularFile(file);
  VdbReader reader(file);
  checkSignature(file, reader);
  VdbHeader header;
  header.formatVersion = reader.read<std::uint32_t>();
  if (header.formatVersion < kOldestFormat)
    fail(ErrorKind::Input,
         "'{}' has OpenVDB's file format {}, and the oldest supported is {}; save it again with a newer "
         "OpenVDB",
         file.string(), header.formatVersion, kOldestFormat);
  reader.skip(2 * sizeof(std::uint32_t));  // library version
  header.hasOffsets = reader.read<char>() != 0;
  reader.skip(kUuidLength);
  skipMetadata(reader);
  const auto gridCount = reader.read<std::int32_t>();
  // OpenVDB makes room for as many grids as a stream counts before it reads the first one.
  constexpr std::uint64_t kMinGridBytes = 3 * sizeof(std::uint32_t) + 3 * sizeof(std::int64_t) + 3 * sizeof(std::uint32_t);
  if (gridCount < 0) reader.failDamaged("its header counts {} grids", gridCount);
  reader.require(std::uint64_t(gridCount) * kMinGridBytes);
  if (!header.hasOffsets) {
    checkStreamedGrids(reader, gridCount, progress);
    return header;
  }
  for (std::int32_t i = 0; i < gridCount; ++i) header.grids.push_back(readGridEntry(reader));
  return header;
}

}  // namespace freevoxels
