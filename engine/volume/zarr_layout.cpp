#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "engine/core/json_file.h"
#include "engine/volume/scan_reader.h"
#include "engine/volume/zarr_array.h"

namespace freevoxels {

namespace {

using ZarrJson = nlohmann::json;
using Extents = std::vector<std::uint64_t>;

constexpr std::uint64_t kMaxMetadata = std::uint64_t(64) << 20, kMaxChunk = std::uint64_t(1) << 30;

/// Parses the description of one array, whose name is in the sentences of its errors.
class LayoutParser {
 public:
  LayoutParser(const FileStore& store, const std::string& folder) : store_(store), folder_(folder) {}

  ZarrLayout parse() {
    if (const ZarrJson third = zarrJson(store_, at("zarr.json")); third.is_object()) {
      name_ = store_.shown(at("zarr.json"));
      parseThird(third);
    } else if (const ZarrJson second = zarrJson(store_, at(".zarray")); second.is_object()) {
      name_ = store_.shown(at(".zarray"));
      parseSecond(second);
    } else {
      fail(ErrorKind::Input, "there is no array at '{}': copy all of the Zarr hierarchy", store_.shown(folder_));
    }
    checkExtents();
    return std::move(layout_);
  }

 private:
  std::string at(const std::string& file) const { return folder_.empty() ? file : folder_ + "/" + file; }

  [[noreturn]] void failOf(std::string_view what) const { failDamaged(name_, fmt::format("its {} is missing or wrong", what)); }

  static const ZarrJson& member(const ZarrJson& object, const char* key) {
    static const ZarrJson none;
    const auto found = object.is_object() ? object.find(key) : object.end();
    return object.is_object() && found != object.end() ? *found : none;
  }

  std::string textOf(const ZarrJson& object, const char* key, const std::string& without = "") const {
    const ZarrJson& value = member(object, key);
    if (value.is_null() && !without.empty()) return without;
    if (!value.is_string()) failOf(key);
    return value.get<std::string>();
  }

  Extents extentsOf(const ZarrJson& object, const char* key) const {
    const ZarrJson& list = member(object, key);
    constexpr std::size_t kMaxAxes = 16;
    if (!list.is_array() || list.empty() || list.size() > kMaxAxes) failOf(key);
    Extents extents;
    for (const ZarrJson& one : list) {
      if (!one.is_number_unsigned() || one.get<std::uint64_t>() < 1) failOf(key);
      extents.push_back(one.get<std::uint64_t>());
    }
    return extents;
  }

  void takeType(const std::string& name) {
    if (name == "bool") return;
    layout_.isHalf = name == "float16";
    const std::optional<SampleType> type = layout_.isHalf ? SampleType::F32 : sampleTypeOf(name);
    if (!type)
      fail(ErrorKind::Input, "'{}' has values of the type '{}', and scans have whole numbers of 8 to 64 bits or floats: convert it", name_,
           name);
    layout_.type = *type;
  }

  /// "<u2", "|b1": order of bytes, kind, and bytes of a value.
  void takeTypeOfSecond(const ZarrJson& json) {
    const std::string text = member(json, "dtype").is_string() ? textOf(json, "dtype") : inShort(member(json, "dtype"));
    const std::string kind = text.size() == 3 ? text.substr(1, 1) : "";
    const int bits = text.size() == 3 && text[2] >= '1' && text[2] <= '8' ? 8 * (text[2] - '0') : 0;
    const std::string word = kind == "u" ? "uint" : kind == "i" ? "int" : kind == "f" ? "float" : "";
    takeType(kind == "b" && bits == 8 ? "bool" : word.empty() ? text : fmt::format("{}{}", word, bits));
    layout_.isBigEndian = text.starts_with('>');
  }

  void takeFill(const ZarrJson& value) {
    constexpr float kMaxFloat = std::numeric_limits<float>::max();
    if (value.is_boolean())
      layout_.fill = value.get<bool>() ? 1.0f : 0.0f;
    else if (value.is_number())
      layout_.fill = float(std::clamp(value.get<double>(), -double(kMaxFloat), double(kMaxFloat)));
    else if (value == "Infinity" || value == "-Infinity")
      layout_.fill = std::numeric_limits<float>::infinity() * (value == "Infinity" ? 1.0f : -1.0f);
    else if (value.is_string())  // "NaN", or its bits
      layout_.fill = std::numeric_limits<float>::quiet_NaN();
  }

  void parseSecond(const ZarrJson& json) {
    layout_.shape = extentsOf(json, "shape");
    layout_.shard = layout_.chunk = extentsOf(json, "chunks");
    takeTypeOfSecond(json);
    takeFill(member(json, "fill_value"));
    if (const ZarrJson& filters = member(json, "filters"); filters.is_array() && !filters.empty())
      fail(ErrorKind::Input, "'{}' has the filter {}, and arrays without filters are read: write it without", name_, inShort(filters[0]));
    if (const ZarrJson& compressor = member(json, "compressor"); !compressor.is_null())
      layout_.codecs.push_back(chunkCodec(textOf(compressor, "id"), name_));
    std::vector<std::size_t> order(layout_.chunk.size());
    std::iota(order.begin(), order.end(), 0);
    if (textOf(json, "order", "C") == "F") std::ranges::reverse(order);
    takeOrder(order);
    layout_.keySeparator = textOf(json, "dimension_separator", ".");
  }

  void parseThird(const ZarrJson& json) {
    if (textOf(json, "node_type") != "array") failOf("node_type");
    layout_.shape = extentsOf(json, "shape");
    const ZarrJson& grid = member(json, "chunk_grid");
    if (textOf(grid, "name") != "regular") failOf("chunk_grid");
    layout_.shard = extentsOf(member(grid, "configuration"), "chunk_shape");
    takeType(member(json, "data_type").is_string() ? textOf(json, "data_type") : inShort(member(json, "data_type")));
    takeFill(member(json, "fill_value"));
    const ZarrJson& keys = member(json, "chunk_key_encoding");
    const bool isDefault = textOf(keys, "name") == "default";
    layout_.keySeparator = textOf(member(keys, "configuration"), "separator", isDefault ? "/" : ".");
    if (isDefault) layout_.keyPrefix = "c" + layout_.keySeparator;
    const ZarrJson& codecs = member(json, "codecs");
    if (codecs.is_array() && codecs.size() == 1 && nameOfCodec(codecs[0]) == "sharding_indexed") {
      takeShards(member(codecs[0], "configuration"));
      return;
    }
    layout_.chunk = layout_.shard;
    takeCodecs(codecs);
  }

  std::string nameOfCodec(const ZarrJson& codec) const { return codec.is_string() ? codec.get<std::string>() : textOf(codec, "name"); }

  void takeShards(const ZarrJson& configuration) {
    layout_.isSharded = true;
    layout_.chunk = extentsOf(configuration, "chunk_shape");
    layout_.indexIsAtStart = textOf(configuration, "index_location", "end") == "start";
    const ZarrJson& codecs = member(configuration, "index_codecs");
    if (!codecs.is_array() || codecs.empty() || nameOfCodec(codecs[0]) != "bytes" ||
        textOf(member(codecs[0], "configuration"), "endian", "little") != "little" || codecs.size() > 2 ||
        (codecs.size() == 2 && nameOfCodec(codecs[1]) != "crc32c"))
      fail(ErrorKind::Input, "'{}' has shards with an index of the codecs {}, and little-endian bytes with crc32c are read: write it so",
           name_, inShort(codecs));
    layout_.indexHasChecksum = codecs.size() == 2;
    takeCodecs(member(configuration, "codecs"));
  }

  void takeCodecs(const ZarrJson& codecs) {
    if (!codecs.is_array()) failOf("codecs");
    std::vector<std::size_t> order(layout_.chunk.size());
    std::iota(order.begin(), order.end(), 0);
    bool isBytes = false;
    for (const ZarrJson& codec : codecs) {
      const std::string name = nameOfCodec(codec);
      const ZarrJson& configuration = member(codec, "configuration");
      if (name == "transpose" && !isBytes) {
        order = transposed(order, configuration);
      } else if (name == "bytes" && !isBytes) {
        isBytes = true;
        layout_.isBigEndian = textOf(configuration, "endian", "little") == "big";
      } else {
        layout_.codecs.push_back(chunkCodec(name, name_));
      }
    }
    if (!isBytes) failOf("codec 'bytes'");
    takeOrder(order);
  }

  std::vector<std::size_t> transposed(const std::vector<std::size_t>& order, const ZarrJson& configuration) const {
    const ZarrJson& list = member(configuration, "order");
    std::vector<std::size_t> result;
    for (const ZarrJson& one : list.is_array() ? list : ZarrJson::array()) {
      if (!one.is_number_unsigned() || one.get<std::uint64_t>() >= order.size()) failOf("order");
      result.push_back(order[one.get<std::size_t>()]);
    }
    std::vector<std::size_t> sorted = result;
    std::ranges::sort(sorted);
    if (result.size() != order.size() || std::ranges::adjacent_find(sorted) != sorted.end()) failOf("order");
    return result;
  }

  /// `order`: the axes from the slowest to the fastest in a chunk.
  void takeOrder(const std::vector<std::size_t>& order) {
    layout_.strides.assign(order.size(), 0);
    std::uint64_t stride = 1;
    for (std::size_t i = order.size(); i-- > 0;) {
      layout_.strides[order[i]] = stride;
      if (layout_.chunk[order[i]] > kMaxChunk / stride)
        fail(ErrorKind::Input, "'{}' has chunks of more than {} values, which are not read: write it with smaller ones", name_, kMaxChunk);
      stride *= layout_.chunk[order[i]];
    }
  }

  void checkExtents() const {
    const std::size_t axes = layout_.shape.size();
    if (layout_.chunk.size() != axes || layout_.shard.size() != axes) failOf("number of axes of chunks");
    if (layout_.bytesOfChunk() > kMaxChunk)
      fail(ErrorKind::Input, "'{}' has chunks of {} MiB, and those of up to {} are read: write it with smaller ones", name_,
           layout_.bytesOfChunk() >> 20, kMaxChunk >> 20);
    constexpr std::uint64_t kMaxChunks = std::uint64_t(1) << 24;  // of a shard
    std::uint64_t chunks = 1;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      if (layout_.shard[axis] % layout_.chunk[axis] != 0) failOf("extent of shards");
      if (layout_.shard[axis] / layout_.chunk[axis] > kMaxChunks / chunks) failOf("extent of shards");
      chunks *= layout_.shard[axis] / layout_.chunk[axis];
    }
  }

  const FileStore& store_;
  const std::string folder_;
  std::string name_;  ///< of the file of metadata
  ZarrLayout layout_;
};

}  // namespace

std::uint64_t ZarrLayout::bytesOfChunk() const {
  return std::accumulate(chunk.begin(), chunk.end(), bytesOfValue(), std::multiplies<>());
}

nlohmann::json zarrJson(const FileStore& store, const std::string& name) {
  const std::unique_ptr<StoredFile> file = store.open(name, kMaxMetadata);
  if (!file) return nullptr;
  const std::vector<std::byte> bytes = readAll(store, name, *file);
  nlohmann::json json = parseJsonQuietly({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!json.is_object()) failDamaged(store.shown(name), "it is no JSON object");
  return json;
}

ZarrLayout zarrLayout(const FileStore& store, const std::string& folder) {
  return LayoutParser(store, folder).parse();
}

}  // namespace freevoxels
