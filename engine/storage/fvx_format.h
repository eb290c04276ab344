#pragma once
// The binary layout of baked volumes (.fvx), described with all offsets in engine/docs/fvx_format.md. Numbers
// are little-endian.

#include <array>
#include <bit>
#include <cstdint>

#include "engine/octree/hilbert.h"
#include "engine/volume/scalar_bricks.h"

namespace freevoxels::fvx {

static_assert(std::endian::native == std::endian::little, "baked volumes are written and read as they lie in memory");

/// First bytes of a file. Transfers that treat it as text change or cut them, as in PNG and KTX files.
inline constexpr std::array<std::uint8_t, 12> kIdentifier{0xab, 'F', 'V', 'X', ' ', '0', '1', 0xbb, '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint32_t kByteOrderMark = 0x04030201, kOtherByteOrderMark = 0x01020304;

/// A reader accepts files of its own major version and any minor version.
inline constexpr std::uint16_t kMajorVersion = 1, kMinorVersion = 4;

inline constexpr std::uint64_t kPageBytes = 4096;      ///< sections begin at multiples of this
inline constexpr std::uint64_t kChunkAlignment = 64;   ///< chunks begin at multiples of this
inline constexpr int kChunkEdge = 32;                  ///< voxels
inline constexpr int kChunkBricks = 64;                ///< bricks of ScalarBricks in a chunk
inline constexpr int kMaxLevels = 9;                  ///< of the octree, level 0 included
inline constexpr int kLongestEdge = kChunkEdge << kMaxHilbertBits;  ///< of a volume, voxels
inline constexpr int kChunkVoxels = kChunkEdge * kChunkEdge * kChunkEdge;
inline constexpr int kBrickVoxels = ScalarBricks::kEdge * ScalarBricks::kEdge * ScalarBricks::kEdge;
static_assert(kChunkBricks * kBrickVoxels == kChunkVoxels);

/// The place in its chunk of a brick by its number, in bricks.
inline glm::ivec3 cellInChunk(int brick) {
  constexpr int n = kChunkEdge / ScalarBricks::kEdge;
  return {brick % n, brick / n % n, brick / (n * n)};
}

enum class SectionKind : std::uint32_t {
  Description = 1,   ///< JSON: everything that a reader needs to know of the volume
  Provenance = 2,    ///< JSON: the origin of the file, for information
  ChunkIndex = 3,    ///< ChunkEntry, in Hilbert order
  Chunks = 4,        ///< the data that the index refers to
  ContentCells = 5,  ///< ContentHeader and a bit for each cell
  // 6 and 7 were written by version 1.1; like all other kinds they are not read.
};

enum class Channel : std::uint32_t { Scalars = 0, Temperature = 1, Albedo = 2 };
inline constexpr int kChannels = 3;

enum class Codec : std::uint32_t {
  None = 0,
  PlanesZstd = 1,  ///< first all first bytes of the values, then all second bytes and so on, compressed with Zstandard
};

/// An entry of the header's section table.
struct Section {
  SectionKind kind{};
  Channel channel{};       ///< for chunk sections; otherwise 0
  std::uint32_t level = 0;  ///< level of the octree for chunk sections; otherwise 0
  std::uint32_t reserved0 = 0;
  std::uint64_t offset = 0;  ///< from the beginning of the file
  std::uint64_t bytes = 0;
  std::uint64_t hash = 0;  ///< XXH3-64 of the section's bytes
  std::array<std::uint64_t, 3> reserved1{};
};
static_assert(sizeof(Section) == 64);

inline constexpr int kMaxSections = 62;

struct Header {
  std::array<std::uint8_t, 12> identifier = kIdentifier;
  std::uint32_t byteOrderMark = kByteOrderMark;
  std::uint16_t majorVersion = kMajorVersion, minorVersion = kMinorVersion;
  std::uint32_t sectionCount = 0;
  std::uint64_t fileBytes = 0;
  std::uint64_t hash = 0;  ///< XXH3-64 of these 4096 bytes with 0 here
  std::array<std::uint8_t, 88> reserved{};
  std::array<Section, kMaxSections> sections{};
};
static_assert(sizeof(Header) == kPageBytes);
static_assert(3 + 2 * kChannels * kMaxLevels <= kMaxSections);

/// The visible cells of the volume (ContentCells of subject.h), followed by a bit for each, x fastest.
struct ContentHeader {
  glm::ivec3 cells{0};
  std::uint32_t reserved = 0;
  double edge = 1.0;  ///< voxels
};
static_assert(sizeof(ContentHeader) == 24);

/// The index entry of a chunk.
struct ChunkEntry {
  glm::ivec3 cell{0};           ///< it starts at voxel kChunkEdge * cell of its level
  Codec codec = Codec::None;
  /// Bit x + 4 (y + 4 z), the number of the brick: whether the chunk has brick (x,y,z); bricks are stored in the order of the bits.
  std::uint64_t brickMask = 0;
  std::uint64_t offset = 0;     ///< from the beginning of the file
  std::uint64_t storedBytes = 0;
  std::uint64_t bytes = 0;  ///< after decompression
  std::uint64_t hash = 0;   ///< XXH3-64 of the stored bytes
  float minimum = 0.0f, maximum = 0.0f;                  ///< of the active values
  float leastExtinction = 0.0f, mostExtinction = 0.0f;  ///< extinction per world unit of scalars between the two; otherwise 0
  std::uint32_t activeVoxels = 0;
  std::array<std::uint32_t, 5> reserved{};

  int bricks() const { return std::popcount(brickMask); }
  bool hasBrick(int brick) const { return (brickMask >> brick & 1u) != 0; }
  /// Where a brick of it starts, in bricks of its level.
  glm::ivec3 brickCell(int brick) const { return cell * (kChunkEdge / ScalarBricks::kEdge) + cellInChunk(brick); }
};
static_assert(sizeof(ChunkEntry) == 96);

}  // namespace freevoxels::fvx
