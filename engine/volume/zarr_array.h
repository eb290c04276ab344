#pragma once
// Internal to the reader of OME-Zarr: an array of Zarr 2 (https://zarr-specs.readthedocs.io/en/latest/v2/v2.0.html) or Zarr 3
// (https://zarr-specs.readthedocs.io/en/latest/v3/core/index.html), of which the chunks are read that are needed.

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/core/stages.h"
#include "engine/volume/chunk_codecs.h"
#include "engine/volume/file_store.h"
#include "engine/volume/scan_voxels.h"

namespace freevoxels {

/// Which voxels of an array are read: a range along three of its axes, at one place of the others.
struct ZarrBox {
  std::array<int, 3> axes{-1, -1, -1};  ///< axes of the array that are x, y and z; -1: none, of which the box has the extent 1
  std::vector<std::uint64_t> place;     ///< along each axis of the array; those of x, y and z are not used
  /// Along x, y and z, inclusive; `last` may be beyond the array.
  glm::ivec3 first{0}, last{std::numeric_limits<int>::max() - 1};
};

/// The description of an array.
struct ZarrLayout {
  std::vector<std::uint64_t> shape, chunk, shard;  ///< `shard` is of the files, and that of a chunk where a file has one
  std::vector<std::uint64_t> strides;              ///< of a chunk, in values
  SampleType type = SampleType::U8;
  bool isHalf = false, isBigEndian = false;  ///< isHalf: values are floats of 16 bits, and `type` is that which they become
  float fill = 0.0f;                         ///< of chunks that are not there
  std::vector<ChunkCodec> codecs;
  bool isSharded = false, indexIsAtStart = false, indexHasChecksum = false;
  std::string keyPrefix, keySeparator;  ///< of the names of chunks: "c/" and "/"

  std::uint64_t bytesOfValue() const { return isHalf ? 2 : bytesOf(type); }
  std::uint64_t bytesOfChunk() const;
};

/// The metadata of Zarr in a file, as JSON; null where there is no such file. Fails with ErrorKind::Input for what is no object.
nlohmann::json zarrJson(const FileStore& store, const std::string& name);
/// Fails with ErrorKind::Input where there is no array, its description is damaged, or it has what is not read, such as other codecs.
ZarrLayout zarrLayout(const FileStore& store, const std::string& folder);

class ZarrArray {
 public:
  /// `folder` is its place in the store, which must live as long. Fails as zarrLayout does.
  ZarrArray(const FileStore& store, std::string folder) : store_(store), folder_(std::move(folder)), layout_(zarrLayout(store, folder_)) {}

  const ZarrLayout& layout() const { return layout_; }
  /// Hands out the chunks that have voxels of the box by several threads. Fails with ErrorKind::Input for chunks that are damaged, by their
  /// names.
  void read(const ZarrBox& box, const SampleSink& sink, const Progress& progress) const;
  /// Host memory of reading.
  std::uint64_t bytesToRead() const;

 private:
  struct Piece;
  struct Shard;

  std::string nameOf(const std::vector<std::uint64_t>& shard) const;
  std::vector<Piece> piecesOf(const ZarrBox& box, glm::ivec3 shard) const;
  std::vector<std::uint64_t> indexOf(const std::string& name, const StoredFile& file) const;
  void readPiece(const ZarrBox& box, const Piece& piece, const SampleSink& sink) const;
  std::vector<std::byte> bytesOfPiece(const Piece& piece) const;
  std::size_t piecesAtOnce() const;

  const FileStore& store_;
  const std::string folder_;
  const ZarrLayout layout_;
};

}  // namespace freevoxels
