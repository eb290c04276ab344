// File layout: "OpenEXR File Layout", openexr.com. Numbers are little-endian.
#include "engine/image/exr_claims.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/printable.h"

namespace freevoxels {

namespace {

/// Bytes of a chunk that a small file may claim, since a tile may be larger than its image: 4096x4096 pixels of four channels of halves.
constexpr double kFewBytes = 1 << 27;

/// How OpenEXR compresses, by its numbers: lines of a chunk, and an upper bound of the factor by which pixels of one value shrink. Deflate
/// reaches 1032; PIZ's Huffman codes stand for 256 values of two bytes in ten bits; DWA keeps a value of each 64, and deflates these.
struct Compression {
  std::int64_t lines;
  double factor;
};
/// Of channels of whole numbers, which no compression changes.
constexpr double kLosslessFactor = 1100.0;
constexpr std::array<Compression, 10> kCompressions{
    {{1, 1.0}, {1, 128.0}, {1, 1100.0}, {16, 1100.0}, {32, 1100.0}, {16, 1500.0}, {32, 16.0}, {32, 16.0}, {32, 131072.0}, {256, 131072.0}}};

/// The attributes of a part that say how large it is, by name.
using Attributes = std::map<std::string, std::vector<char>>;

bool tellsSize(const std::string& name) {
  return name == "dataWindow" || name == "channels" || name == "compression" || name == "tiles" || name == "type" || name == "chunkCount";
}

template <typename Value>
std::optional<Value> valueOf(const Attributes& attributes, const char* name) {
  const auto found = attributes.find(name);
  if (found == attributes.end() || found->second.size() < sizeof(Value)) return std::nullopt;
  Value value;
  std::memcpy(&value, found->second.data(), sizeof(value));
  return value;
}

/// The bytes before the next 0; nothing if the file ends, or if they are more than OpenEXR's names can have.
std::optional<std::string> nameIn(std::istream& stream) {
  constexpr std::size_t kLongestName = 255;
  std::string name;
  for (int byte = stream.get(); byte != std::istream::traits_type::eof(); byte = stream.get()) {
    if (byte == 0) return name;
    if (name.size() == kLongestName) return {};
    name.push_back(char(byte));
  }
  return {};
}

/// Bytes that OpenEXR takes for a value of this type and size: a preview's are counted by its own width and height.
std::uint64_t bytesOfValue(const std::string& type, std::uint32_t size, std::istream& stream) {
  std::array<std::uint32_t, 2> extent{};
  if (type != "preview" || !stream.read(reinterpret_cast<char*>(extent.data()), sizeof(extent))) return size;
  stream.seekg(-std::streamoff(sizeof(extent)), std::ios::cur);
  const std::uint64_t pixels = std::uint64_t(extent[0]) * extent[1];
  return std::max<std::uint64_t>(size, 4 * std::min(pixels, std::uint64_t(1) << 60));
}

/// Bytes of a line of pixels that has samples of all channels, and the least number of bytes that a file has of a line on average.
struct LineBytes {
  double pixels = 0.0, stored = 0.0;
};

/// Nothing if the list of channels is damaged.
std::optional<LineBytes> lineBytes(const std::vector<char>& channels, double width, const Compression& compression) {
  enum PixelType : std::int32_t { Uint, Half };
  struct Channel {
    std::int32_t type;
    std::array<char, 4> other;
    std::int32_t samplingX, samplingY;
  };
  static_assert(sizeof(Channel) == 16);
  LineBytes bytes;
  for (auto at = channels.begin(); at != channels.end() && *at != 0;) {
    at = std::find(at, channels.end(), '\0');
    if (channels.end() - at <= std::ptrdiff_t(sizeof(Channel))) return std::nullopt;
    Channel channel;
    std::memcpy(&channel, &*at + 1, sizeof(channel));
    at += 1 + std::ptrdiff_t(sizeof(channel));
    const double pixels = std::max(width / std::max(channel.samplingX, 1), 1.0) * (channel.type == Half ? 2.0 : 4.0);
    bytes.pixels += pixels;
    const double factor = channel.type == Uint ? std::min(compression.factor, kLosslessFactor) : compression.factor;
    bytes.stored += pixels / (factor * std::max(channel.samplingY, 1));
  }
  return bytes;
}

/// The attribute that OpenEXR follows in files of several parts or of deep samples; empty if it is missing.
std::string typeOf(const Attributes& part) {
  const auto type = part.find("type");
  return type == part.end() ? std::string() : std::string(type->second.begin(), type->second.end());
}

class ClaimCheck {
 public:
  explicit ClaimCheck(const std::filesystem::path& file)
      : file_(file), stream_(file, std::ios::binary), bytes_(std::filesystem::file_size(file)) {}

  void check() {
    std::array<char, 8> start{};  // the magic number and the version, whose bits say what the file has
    if (!stream_.read(start.data(), start.size())) return;
    constexpr int kTiles = 0x02, kDeepSamples = 0x08, kParts = 0x10;
    const bool hasParts = (start[5] & kParts) != 0, hasTypes = (start[5] & (kDeepSamples | kParts)) != 0;
    while (const std::optional<Attributes> part = readHeader()) {
      if (part->empty()) return;  // an empty header ends the list of them
      const std::string type = hasTypes ? typeOf(*part) : "";
      checkPart(*part, hasTypes ? type == "tiledimage" || type == "deeptile" : (start[5] & kTiles) != 0, type.starts_with("deep"));
      if (!hasParts) return;
    }
  }

 private:
  /// Nothing if the file ends or has what OpenEXR will refuse.
  std::optional<Attributes> readHeader() {
    Attributes attributes;
    for (;;) {
      const std::optional<std::string> name = nameIn(stream_);
      if (!name) return std::nullopt;
      if (name->empty()) return attributes;
      const std::optional<std::string> type = nameIn(stream_);
      std::uint32_t size = 0;
      if (!type || !stream_.read(reinterpret_cast<char*>(&size), sizeof(size))) return std::nullopt;
      if (bytesOfValue(*type, size, stream_) > bytes_ - std::uint64_t(stream_.tellg()))
        fail(ErrorKind::Input, "cannot read '{}': the attribute '{}' of its header is longer than the file; write it again", file_.string(),
             printable(*name));
      std::vector<char> value(tellsSize(*name) ? size : 0);
      if (!stream_.read(value.data(), std::streamsize(value.size()))) return std::nullopt;
      stream_.seekg(size - std::streamoff(value.size()), std::ios::cur);
      if (!attributes.emplace(*name, std::move(value)).second)
        fail(ErrorKind::Input, "cannot read '{}': its header has the attribute '{}' twice; write it again", file_.string(), printable(*name));
    }
  }

  /// Of deep parts, which are not read, any pixel may have no sample.
  void checkPart(const Attributes& part, bool isTiled, bool isDeep) const {
    const auto window = valueOf<std::array<std::int32_t, 4>>(part, "dataWindow");
    const auto channels = part.find("channels");
    if (!window || channels == part.end()) return;
    const double width = double((*window)[2]) - (*window)[0] + 1.0, height = double((*window)[3]) - (*window)[1] + 1.0;
    const auto number = std::size_t(valueOf<std::uint8_t>(part, "compression").value_or(0));
    const Compression compression = number < kCompressions.size() ? kCompressions[number] : kCompressions.back();
    const std::optional<LineBytes> line = lineBytes(channels->second, width, compression);
    if (!line || width < 1.0 || height < 1.0) return;
    if (!isDeep && line->stored * height > double(bytes_))
      fail(ErrorKind::Input, "cannot read '{}': its header claims {:.0f}x{:.0f} pixels, which a file of {} bytes cannot hold; write it again",
           file_.string(), width, height, bytes_);
    double chunkLines = double(compression.lines), chunks = height / chunkLines;
    bool isLargerThanImage = false;
    LineBytes lineOfChunk = *line;
    const auto tile = valueOf<std::array<std::uint32_t, 2>>(part, "tiles");
    if (isTiled && tile) {
      lineOfChunk = lineBytes(channels->second, (*tile)[0], compression).value_or(LineBytes());
      chunkLines = (*tile)[1];
      isLargerThanImage = double((*tile)[0]) > width || chunkLines > height;  // of which the file has a part alone
      chunks = (width / std::max((*tile)[0], 1u)) * (height / std::max((*tile)[1], 1u));
    }
    chunks = std::max(chunks, double(valueOf<std::int32_t>(part, "chunkCount").value_or(0)));
    constexpr double kEntryBytes = 8.0;  // of a chunk in a table of the file
    const bool canHold = !isLargerThanImage && lineOfChunk.stored * chunkLines <= double(bytes_);
    const bool chunkIsTooLarge = !isDeep && !canHold && lineOfChunk.pixels * chunkLines > kFewBytes;
    if (chunkIsTooLarge || kEntryBytes * std::floor(chunks) > double(bytes_))
      fail(ErrorKind::Input, "cannot read '{}': its header claims chunks that a file of {} bytes cannot hold; write it again", file_.string(), bytes_);
  }

  const std::filesystem::path& file_;
  std::ifstream stream_;
  const std::uint64_t bytes_;
};

}  // namespace

void checkExrClaims(const std::filesystem::path& file) {
  ClaimCheck(file).check();
}

}  // namespace freevoxels
