#pragma once
// Zarr hierarchies, written here byte by byte.

#include <blosc.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace freevoxels::test {

/// Files by their names in a hierarchy.
using ZarrFiles = std::map<std::string, std::string>;
using ZarrPlace = std::array<int, 4>;  ///< c, z, y, x

template <typename Value>
void appendTo(std::string& bytes, Value value, bool isSwapped = false) {
  char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof(Value));
  if (isSwapped) std::reverse(raw, raw + sizeof(Value));
  bytes.append(raw, sizeof(Value));
}

inline std::string zstdOf(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
  return packed;
}

inline std::string bloscOf(const std::string& bytes, const char* compressor, int shuffle, std::size_t valueBytes = 2) {
  std::string packed(bytes.size() + BLOSC_MAX_OVERHEAD, '\0');
  packed.resize(
      std::size_t(blosc_compress_ctx(5, shuffle, valueBytes, bytes.size(), bytes.data(), packed.data(), packed.size(), compressor, 0, 1)));
  return packed;
}

/// `windowBits` as zlib has them: 15 with the header of zlib, 31 with that of gzip, -15 with none.
inline std::string deflateOf(const std::string& bytes, int windowBits) {
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, windowBits, 9, Z_DEFAULT_STRATEGY) != Z_OK) throw std::runtime_error("zlib");
  std::string packed(deflateBound(&stream, uLong(bytes.size())) + 32, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = uInt(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = uInt(packed.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) throw std::runtime_error("zlib");
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

inline std::string withCrc32c(std::string bytes) {
  std::uint32_t crc = ~0u;
  for (const char c : bytes) {
    crc ^= std::uint8_t(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0x82f63b78u : 0u);
  }
  appendTo(bytes, ~crc);
  return bytes;
}

/// An array with the axes c, z, y and x.
struct ZarrFixture {
  std::array<int, 4> shape{3, 5, 7, 11}, chunk{1, 2, 4, 5};
  std::function<int(ZarrPlace)> valueAt = [](ZarrPlace v) { return 1 + v[3] + 11 * v[2] + 77 * v[1] + 1000 * v[0]; };
  std::function<std::string(std::string)> pack = [](std::string bytes) { return bytes; };
  /// Appends a value to the bytes of a chunk.
  std::function<void(std::string&, int)> append = [](std::string& bytes, int value) { appendTo(bytes, std::uint16_t(value)); };
  bool isReversed = false;  ///< whether x is the slowest in a chunk

  std::string chunkAt(std::array<int, 4> number) const {
    std::string bytes;
    const auto addAt = [&](ZarrPlace inChunk) {
      ZarrPlace place{};
      bool isInside = true;
      for (std::size_t a = 0; a < 4; ++a) {
        place[a] = number[a] * chunk[a] + inChunk[a];
        isInside &= place[a] < shape[a];
      }
      append(bytes, isInside ? valueAt(place) : 0);
    };
    for (int i = 0; i < chunk[0] * chunk[1] * chunk[2] * chunk[3]; ++i) {
      ZarrPlace inChunk{};
      for (std::size_t k = 0, rest = std::size_t(i); k < 4; ++k) {
        const std::size_t axis = isReversed ? k : 3 - k;
        inChunk[axis] = int(rest % std::size_t(chunk[axis]));
        rest /= std::size_t(chunk[axis]);
      }
      addAt(inChunk);
    }
    return pack(bytes);
  }

  /// Calls `work` for the number of each chunk, or of each shard of `files` chunks.
  void forEach(std::array<int, 4> files, const std::function<void(std::array<int, 4>)>& work) const {
    std::array<int, 4> counts{};
    for (std::size_t a = 0; a < 4; ++a) counts[a] = (shape[a] - 1) / (chunk[a] * files[a]) + 1;
    for (int c = 0; c < counts[0]; ++c)
      for (int z = 0; z < counts[1]; ++z)
        for (int y = 0; y < counts[2]; ++y)
          for (int x = 0; x < counts[3]; ++x) work({c, z, y, x});
  }

  static std::string keyOf(std::array<int, 4> n, const std::string& separator) {
    return std::to_string(n[0]) + separator + std::to_string(n[1]) + separator + std::to_string(n[2]) + separator + std::to_string(n[3]);
  }

  /// Zarr 2. `more` replaces members of .zarray.
  void addSecond(ZarrFiles& files, const std::string& folder, const nlohmann::json& more = nlohmann::json::object()) const {
    nlohmann::json json{{"zarr_format", 2}, {"shape", shape},        {"chunks", chunk},
                        {"dtype", "<u2"},   {"compressor", nullptr}, {"fill_value", 0},
                        {"order", "C"},     {"filters", nullptr},    {"dimension_separator", "/"}};
    json.update(more);
    files[folder + "/.zarray"] = json.dump();
    forEach({1, 1, 1, 1}, [&](std::array<int, 4> n) { files[folder + "/" + keyOf(n, json["dimension_separator"])] = chunkAt(n); });
  }

  /// Zarr 3, of chunks, or of shards of so many chunks along each axis, with their index at the end.
  void addThird(ZarrFiles& files, const std::string& folder, nlohmann::json codecs, std::array<int, 4> perShard = {1, 1, 1, 1},
                const nlohmann::json& more = nlohmann::json::object()) const {
    const bool isSharded = perShard != std::array<int, 4>{1, 1, 1, 1};
    std::array<int, 4> ofFile{};
    for (std::size_t a = 0; a < 4; ++a) ofFile[a] = chunk[a] * perShard[a];
    if (isSharded)
      codecs = {{{"name", "sharding_indexed"},
                 {"configuration",
                  {{"chunk_shape", chunk},
                   {"codecs", codecs},
                   {"index_codecs", {{{"name", "bytes"}, {"configuration", {{"endian", "little"}}}}, {{"name", "crc32c"}}}},
                   {"index_location", "end"}}}}};
    nlohmann::json json{{"zarr_format", 3},
                        {"node_type", "array"},
                        {"shape", shape},
                        {"data_type", "uint16"},
                        {"chunk_grid", {{"name", "regular"}, {"configuration", {{"chunk_shape", ofFile}}}}},
                        {"chunk_key_encoding", {{"name", "default"}, {"configuration", {{"separator", "/"}}}}},
                        {"fill_value", 0},
                        {"codecs", codecs},
                        {"attributes", nlohmann::json::object()}};
    json.update(more);
    files[folder + "/zarr.json"] = json.dump();
    forEach(perShard, [&](std::array<int, 4> n) { files[folder + "/c/" + keyOf(n, "/")] = isSharded ? shardAt(n, perShard) : chunkAt(n); });
  }

  /// Chunks beyond the array are absent.
  std::string shardAt(std::array<int, 4> number, std::array<int, 4> perShard) const {
    std::string bytes, index;
    for (int c = 0; c < perShard[0]; ++c)
      for (int z = 0; z < perShard[1]; ++z)
        for (int y = 0; y < perShard[2]; ++y)
          for (int x = 0; x < perShard[3]; ++x) {
            const std::array<int, 4> n{number[0] * perShard[0] + c, number[1] * perShard[1] + z, number[2] * perShard[2] + y,
                                       number[3] * perShard[3] + x};
            bool isInside = true;
            for (std::size_t a = 0; a < 4; ++a) isInside &= n[a] * chunk[a] < shape[a];
            const std::string one = isInside ? chunkAt(n) : "";
            appendTo(index, isInside ? std::uint64_t(bytes.size()) : ~std::uint64_t(0));
            appendTo(index, isInside ? std::uint64_t(one.size()) : ~std::uint64_t(0));
            bytes += one;
          }
    return bytes + withCrc32c(index);
  }
};

/// The multiscales of arrays "0", "1", ..., with the axes c, z, y and x, of 0.5 x 0.25 x 0.25 micrometres, and twice that along x and y for
/// every level.
inline nlohmann::json multiscalesOf(int levels, const std::string& version = "0.4") {
  nlohmann::json image{{"version", version}, {"axes", {{{"name", "c"}, {"type", "channel"}}}}, {"datasets", nlohmann::json::array()}};
  for (const char* name : {"z", "y", "x"}) image["axes"].push_back({{"name", name}, {"type", "space"}, {"unit", "micrometer"}});
  for (int i = 0; i < levels; ++i) {
    const double edge = 0.25 * double(1 << i);
    image["datasets"].push_back(
        {{"path", std::to_string(i)},
         {"coordinateTransformations",
          {{{"type", "scale"}, {"scale", {1.0, 0.5, edge, edge}}}, {{"type", "translation"}, {"translation", {0.0, 10.0, 20.0, 30.0}}}}}});
  }
  return nlohmann::json::array({image});
}

inline nlohmann::json omeroChannel(const char* label, const char* color, bool isActive, double start, double end) {
  return {{"label", label}, {"color", color}, {"active", isActive}, {"window", {{"start", start}, {"end", end}}}};
}

/// The image of a hierarchy of Zarr 2, or, in `ome`, of Zarr 3.
inline void addImage(ZarrFiles& files, const nlohmann::json& attributes, bool isThird = false) {
  if (isThird)
    files["zarr.json"] = nlohmann::json{{"zarr_format", 3}, {"node_type", "group"}, {"attributes", {{"ome", attributes}}}}.dump();
  else
    files[".zattrs"] = attributes.dump();
}

/// The files as a zip archive, all entries of which are in `top`.
inline std::string zipOf(const ZarrFiles& files, bool isDeflated, const std::string& top = "") {
  std::string bytes, directory;
  for (const auto& [name, plain] : files) {
    const std::string packed = isDeflated ? deflateOf(plain, -15) : plain, full = top + name;
    const auto size = std::uint32_t(plain.size()), crc = std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(plain.data()), uInt(size)));
    const auto addFacts = [&](std::string& to) {
      appendTo(to, std::uint16_t(20));
      appendTo(to, std::uint16_t(0));
      appendTo(to, std::uint16_t(isDeflated ? 8 : 0));
      appendTo(to, std::uint32_t(0));
      appendTo(to, crc);
      appendTo(to, std::uint32_t(packed.size()));
      appendTo(to, size);
      appendTo(to, std::uint16_t(full.size()));
      appendTo(to, std::uint16_t(0));
    };
    const auto place = std::uint32_t(bytes.size());
    bytes += "PK\x03\x04";
    addFacts(bytes);
    bytes += full + packed;
    directory += std::string("PK\x01\x02\x14\0", 6);
    addFacts(directory);
    directory.append(10, '\0');
    appendTo(directory, place);
    directory += full;
  }
  const auto begin = std::uint32_t(bytes.size());
  bytes += directory + std::string("PK\x05\x06\0\0\0\0", 8);
  appendTo(bytes, std::uint16_t(files.size()));
  appendTo(bytes, std::uint16_t(files.size()));
  appendTo(bytes, std::uint32_t(directory.size()));
  appendTo(bytes, begin);
  appendTo(bytes, std::uint16_t(0));
  return bytes;
}

}  // namespace freevoxels::test
