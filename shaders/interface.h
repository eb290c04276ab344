// What the C++ side and the shaders share: push constants, records and constants. Included by both; the
// layouts are equal because the shaders use scalar block layout.
#ifndef FREEVOXELS_INTERFACE_H
#define FREEVOXELS_INTERFACE_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace freevoxels::shader {
using glm::ivec2, glm::ivec3, glm::ivec4, glm::mat3, glm::uvec2, glm::vec2, glm::vec3, glm::vec4;
using uint = std::uint32_t;
#define FV_CONSTANT inline constexpr
#else
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#define FV_CONSTANT const
#endif

// Rows of voxels are padded to a multiple of this with voxels that hold nothing, so that a thread of the sweeps
// has whole texels of four voxels: 16 voxels a thread are fastest on lavapipe, 4 on GPUs.
FV_CONSTANT int kRowAlignment = 16;

// Voxels along the edge of a brick, in which the host keeps and hands over scalars.
FV_CONSTANT int kBrickEdge = 8;

// Blocks that one word says of whether they hold anything, and that one invocation of the passes over all blocks
// looks at.
FV_CONSTANT int kBlocksPerWord = 32;
FV_CONSTANT int kOccupancyThreads = 64;
FV_CONSTANT int kScanThreads = 256;

FV_CONSTANT int kBrickThreads = kBrickEdge * kBrickEdge;  // a row of a brick each
FV_CONSTANT int kSweepThreads = 32;
FV_CONSTANT int kExpandTile = 8;
FV_CONSTANT int kRaySweepThreads = 64;
FV_CONSTANT int kEyeThreads = 64;
FV_CONSTANT int kSplatThreads = 64;
FV_CONSTANT int kResolveTile = 8;
FV_CONSTANT int kLevelThreads = 64;
// Blocks in a row of their ranks whose bounds are in one byte: half a byte hides about as much as a whole one. A thread of
// the octree's table makes them together.
FV_CONSTANT int kBoundBlocks = 2;
FV_CONSTANT int kDirectionsPerLevelPass = 13;  // of a dispatch of the octree's table

// Blocks in a row of their ranks whose codes in the table are kept, or are not, together.
FV_CONSTANT int kRunBlocks = 8;
FV_CONSTANT int kRunThreads = 64;

// Levels of the octree: more than any volume has whose voxels 32 bits can number.
FV_CONSTANT int kMaximumLevels = 32;

// Slots that one invocation and one workgroup of the cut look at: a bit each of a word.
FV_CONSTANT int kCutSlotsPerThread = 32;
FV_CONSTANT int kCutThreads = 64;
FV_CONSTANT int kCutSlotsPerGroup = kCutSlotsPerThread * kCutThreads;
// Pixels along the edge of a tile that is covered or not, and the cells that directions of the table can have.
FV_CONSTANT int kCoverTile = 8;
FV_CONSTANT int kCoverThreads = 64;
FV_CONSTANT int kMaximumCells = 125;

// The sort takes its keys digit by digit. As many threads a workgroup as digits, so that each owns one; a
// fixed number of workgroups, whatever the count, so that one of them can add up what all of them found.
FV_CONSTANT int kSortBits = 8;
FV_CONSTANT int kSortDigits = 1 << kSortBits;
FV_CONSTANT int kSortThreads = kSortDigits;
FV_CONSTANT int kSortGroups = 256;

// Splats are set up and drawn in chunks of this many: the records of one chunk are 64 MiB, whatever the
// volume.
FV_CONSTANT int kSplatsPerChunk = 1 << 20;

// The footprint, f(r) = peak (1 - r²/R²)⁴: engine/scene/footprint.h says why.
FV_CONSTANT float kSplatRadius = 1.3960250075605876f;
FV_CONSTANT float kSplatPeak = 5.0f / (3.14159265358979f * kSplatRadius * kSplatRadius);

FV_CONSTANT float kMaximumDepth = 16.0f;  // optical depth that the code depth8 ends at
FV_CONSTANT float kOpaqueDepth = 32.0f;   // what the code linear8 means by a transmittance of 0; rays end there

// Must be engine/volume/volume.h's kInactiveVoxel.
// Of a block that holds anything: one that is mostly empty may have less than 32-bit floats can say.
FV_CONSTANT float kLeastExtinction = 1e-37f;
// Must be engine/volume/classification.h's kMaximumExtinction.
FV_CONSTANT float kMaximumExtinction = 1e30f;

// Must be engine/scene/lighting.h's.
FV_CONSTANT float kHighlight = 0.2f;
FV_CONSTANT float kHighlightExponent = 40.0f;

// The mean over a ball of a block's volume of 1 / distance² from its middle is 1 over this much of the edge's square: no
// block has more light from a source that is in it.
FV_CONSTANT float kNearestLight2 = 0.1283f;

FV_CONSTANT int kCodeDepth8 = 0;
FV_CONSTANT int kCodeLinear8 = 1;
FV_CONSTANT int kFilterGeometric = 0;
FV_CONSTANT int kFilterArithmetic = 1;
FV_CONSTANT int kLookupBilinear = 0;
FV_CONSTANT int kLookupNearest = 1;
FV_CONSTANT int kLookupExact = 2;
FV_CONSTANT int kLookupNone = 4;  // A = 1; 3 is AttenuationLookup::Auto, which is one of the others here
FV_CONSTANT int kCompositeNormalised = 0;
FV_CONSTANT int kCompositeAdditive = 1;
FV_CONSTANT int kCompositeSorted = 2;

// One level of the octree: engine/octree/hierarchy_layout.h.
struct BlockLevel {
  uint first;       // index of its first block
  uint firstRank;   // of its blocks that hold anything
  uint firstBound;  // where in a direction of the table their bounds begin
  int rowPitch;
  ivec3 dimensions;
};

// Device addresses of what is kept of blocks that hold anything: engine/octree/device_volume.h. 0 where there is nothing.
struct BlockStores {
  uvec2 extinction, emission, colors, blockColors;
};

// occupied_voxels.comp and pack_voxels.comp
struct BricksPush {
  BlockLevel voxels;
  BlockStores stores;
  uint brickCount;
  float densityScale;    // extinction per world unit at density 1
};

// The planes that a dispatch of a sweep marches through: engine/attenuation/slabs.h. In the order of the march.
struct SweepSlab {
  int firstPlane, endPlane;
  int firstQuad;     // of all quads of voxels, the first whose extinction is there
  uint firstDepth;   // of the depths that lines have between slabs, this direction's first
};

// attenuation_sweep.comp and attenuation_sweep_x.comp. Offsets and strides are in voxels of the padded grid.
struct SweepPush {
  SweepSlab slab;
  int rowPitch;
  int lineCount;     // extent of the side axis: the axis that is neither x nor the march axis
  int sideStep;      // step along the side axis, wraps around
  int sideStride;
  int marchCount;    // extent of the march axis
  int marchStart;    // offset of the first plane, the one at which the lines enter the volume
  int marchStride;   // to the next plane; negative when marching down
  float stepLength;  // world length of a lattice step
};

// attenuation_sweep_half.comp. Offsets and strides are in voxels of the padded grid.
struct HalfSweepPush {
  SweepSlab slab;
  int rowPitch, start;                     // start: offset of the row at plane 0, side 0
  int marchCount, marchStride, marchStep;  // extent, stride and step of the march axis; step -2, -1, 1 or 2
  int sideCount, sideStride, sideStep;     // the same of the axis that is neither x nor the march axis
  float stepLength;                        // world length of half a step: of one layer
  ivec2 halfway[4];                        // rows around the middle of a step: offsets on the march and side axes
};

// engine/scene/source_rays.h says what the members mean.
struct FaceRays {
  int axis;
  int direction;
  int firstPlane;
  int planeCount;
  ivec2 rayCount;
  vec2 origin, slope;
  float convergence;
  float farthest;
  float spacing;
  uvec2 depths;  // device address: by k and ray, sqrt(depth / kOpaqueDepth) of planes 2k and 2k + 1, 16 bits each
};

// Which blocks hold anything, a bit each, and how many of their level that are before them do. What is kept of
// blocks is kept of those alone, at their ranks: in the order of the blocks, level by level.
struct OccupancyWord {
  uint mask;
  uint before;
};

// Planes of a fan, counted from its first, from `begin` on and before `end`, of which ray_sweep.comp has the extinction:
// that of the voxel of plane k and with the coordinates a and b on the fan's sides is at
//   origin + k planeStride + a strideA + b strideB.
struct RaySlab {
  int begin, end;
  int origin, planeStride, strideA, strideB;
};

// ray_sweep.comp
struct RaySweepPush {
  FaceRays fan;
  mat3 indexToWorld;
  ivec2 sides;  // the volume's dimensions on the fan's sides
  RaySlab slab;
};

// medium_level.comp
struct MediumLevelPush {
  BlockLevel child, parent;
  BlockStores stores;
  ivec3 voxels;        // the volume's dimensions
  int childEdge;       // voxels along a child's edge
  uint parentCount;    // blocks of the parent level that hold anything
  float childLength;   // world length of a child's edge
  uint firstColor;     // rank of the first block that has a colour: of level 1
};

// table_level.comp
struct TableLevelPush {
  BlockLevel child, parent;
  ivec3 voxels;
  int childEdge;
  uint parentCount;    // blocks of the parent level that hold anything
  uint firstDirection, directionCount;  // in the order of directions.h
};

// prune_mark.comp and prune_compact.comp
struct RunsPush {
  uint runCount;
  uint cellCount;  // that could be directions
  uint maxCodePerDirection;    // four codes that say that no light comes through
};

// cut_select.comp, what is the same for all levels of a frame. Positions are relative to the volume's middle.
struct CutFrame {
  BlockLevel levels[kMaximumLevels];
  uint coarseFirst;       // rank of the first block above the voxels
  int top;                // the coarsest level there is
  int finest;             // no level below is drawn
  int coarsest;           // no level above is drawn
  vec3 middle;            // of the volume, index space
  vec3 viewAxis;          // distance from the eye plane: viewAxis . position + middleDistance
  float middleDistance;
  float edgePerDistance;  // a block is small where its edge, in voxels, is at most this times its distance
  vec4 planes[5];         // a box is seen where planes.xyz . centre + planes.w + |planes.xyz| . half edges >= 0
  int outside;            // whether to leave out what is outside of the image
  int hides;              // whether to leave out what is behind others
  float darkDepths[kMaximumCells];  // by cell number: what the table has to hold for a line of sight of length 1
  ivec2 tiles;            // of the image
  // As in SetupFrame.
  mat3 indexToWorld, indexToPixel;
  vec3 eyeToMiddle, middleInPixels;
  vec3 ray;
  int orthographic;
  int pathLengthCorrection, cells;
  vec3 axisLengths;       // world lengths of the index axes
};

// cut_select.comp and cut_write.comp, one level of the cut
struct CutPush {
  int level;
  uint slotCount;      // eight a block of the list of the level above
  uint firstGroup;     // of this level among the workgroups of all drawn levels
  uint firstOffset;    // the same among the counts of all workgroups
};

// What cut_select.comp counts: blocks whose parent was opened.
struct CutCounts {
  uint empty;          // hold nothing
  uint outside;        // of the rest, left out as no part of the image
  uint hidden;         // of the rest, left out behind others
  uint opened;         // of the rest, neither left out nor drawn: their children were looked at
  uint deferred;       // left to the second part of the cut, which counts them again
};

// expand_voxels.comp
struct ExpandPush {
  BlockLevel voxels;
  ivec3 first;   // voxel, whose x is a multiple of 4; may be before those of the volume
  ivec3 extent;  // in quads along x
};

// occupied_blocks.comp
struct OccupiedBlocksPush {
  BlockLevel child, parent;
  uint wordCount;    // of the parent level
};

// compact_count.comp, compact_scan.comp, compact_write.comp
struct CompactPush {
  uint firstWord;    // of the level's occupancy
  uint wordCount;
  uint firstCount;   // compact_scan.comp: where the counts begin; behind them comes their sum
  uint groupCount;   // workgroups of the count and write passes
  uint firstChunk;   // compact_scan.comp writes the arguments of chunkCount draw chunks from here on
  uint chunkCount;
  uvec2 blocks;      // device address of the list that compact_write.comp writes
};

// Arguments of one chunk, in the order that vkCmdDispatchIndirect and vkCmdDrawIndirect want them.
struct ChunkArguments {
  uint groupsX, groupsY, groupsZ;
  uint splatCount, firstSplat;  // of the list
  uint vertexCount, instanceCount, firstVertex, firstInstance;              // points: one vertex a splat
  uint quadVertexCount, quadInstanceCount, quadFirstVertex, quadFirstInstance;  // quads: one instance a splat
};

// depth_key.comp
struct DepthKeyPush {
  mat3 indexToWorld;   // linear part
  vec3 middle;         // of the volume, index space
  vec3 eyeToMiddle;    // world units; orthographic: the viewing direction, of length 1
  float eyeDistance;   // |eyeToMiddle|
  int orthographic;
  int rowPitch;
  int rows;            // extent along y
  uint chunkCount;
};

// radix_count.comp and radix_scatter.comp
struct RadixPush {
  uint shift;  // of the digit that this pass sorts by
};

#ifdef __cplusplus
static_assert(sizeof(BlockLevel) == 28);
static_assert(sizeof(ChunkArguments) == 52);
static_assert(sizeof(CutFrame) <= 16384);  // a uniform buffer, which every device takes up to here
static_assert(sizeof(CutPush) == 16);
static_assert(sizeof(DepthKeyPush) == 80);
static_assert(sizeof(ExpandPush) == 52);
static_assert(sizeof(HalfSweepPush) == 84);
static_assert(sizeof(MediumLevelPush) == 116);
static_assert(sizeof(RaySweepPush) == 128);  // what every device takes
static_assert(sizeof(TableLevelPush) == 84);
}  // namespace freevoxels::shader
#endif
#endif
