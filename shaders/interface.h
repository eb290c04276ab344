// Push constants, records and constants that C++ and the shaders share. Both include this file. The layouts
// are equal because the shaders use scalar block layout.
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

// Rows of voxels are padded to a multiple of this with empty voxels, so that a thread of the sweeps has whole
// texels of four voxels: 16 voxels a thread are fastest on lavapipe, 4 on GPUs.
FV_CONSTANT int kRowAlignment = 16;

// Bricks of 8^3 voxels are cells of the octree this number of levels above the voxels. The host stores and uploads scalars in bricks.
FV_CONSTANT int kBrickLevels = 3;
FV_CONSTANT int kBrickEdge = 1 << kBrickLevels;

// Blocks of an occupancy word, and of an invocation of the passes over all blocks.
FV_CONSTANT int kBlocksPerWord = 32;
FV_CONSTANT int kOccupancyThreads = 64;
FV_CONSTANT int kScanThreads = 256;

FV_CONSTANT int kBrickThreads = kBrickEdge * kBrickEdge;  // one for each row of a brick
FV_CONSTANT int kSweepThreads = 32;
FV_CONSTANT int kExpandTile = 8;
FV_CONSTANT int kRaySweepThreads = 64;
FV_CONSTANT int kEyeThreads = 64;
FV_CONSTANT int kSplatThreads = 64;
FV_CONSTANT int kResolveTile = 8;
FV_CONSTANT int kLevelThreads = 64;
// Blocks of consecutive rank whose bounds share a byte: half a byte hides about as much as a whole one. A
// thread of the octree's table computes them together.
FV_CONSTANT int kBoundBlocks = 2;
FV_CONSTANT int kDirectionsPerLevelPass = 13;  // directions of a dispatch of the octree's table

// Upper bound of the number of levels of an octree whose voxels have 32-bit indices.
FV_CONSTANT int kMaximumLevels = 32;

// Slots of an invocation and of a workgroup of the cut, a bit of a word each.
FV_CONSTANT int kCutSlotsPerThread = 32;
FV_CONSTANT int kCutThreads = 64;
FV_CONSTANT int kCutSlotsPerGroup = kCutSlotsPerThread * kCutThreads;
// The largest number of cells of a set of directions.
FV_CONSTANT int kMaximumCells = 125;

// The radix sort processes its keys digit by digit. A workgroup has a thread for each value of a digit; the
// number of workgroups is fixed, so that one workgroup can add up the counts of all.
FV_CONSTANT int kSortBits = 8;
FV_CONSTANT int kSortDigits = 1 << kSortBits;
FV_CONSTANT int kSortThreads = kSortDigits;
FV_CONSTANT int kSortGroups = 256;

// Splats are set up and drawn in chunks of this number: the records of a chunk take 64 MiB, whatever the
// volume.
FV_CONSTANT int kSplatsPerChunk = 1 << 20;

// The footprint, f(r) = peak (1 - r²/R²)⁴; engine/scene/footprint.h gives the reason.
FV_CONSTANT float kSplatRadius = 1.3960250075605876f;
FV_CONSTANT float kSplatPeak = 5.0f / (3.14159265358979f * kSplatRadius * kSplatRadius);

FV_CONSTANT float kMaximumDepth = 16.0f;  // largest optical depth of the code depth8
// Optical depth of a transmittance of 0 in the code linear8, and the largest depth along rays.
FV_CONSTANT float kOpaqueDepth = 32.0f;

// The least extinction of an occupied block: a block that is mostly empty might have less than 32-bit floats
// can represent.
FV_CONSTANT float kMinExtinction = 1e-37f;
// Must equal kMaxExtinction of engine/volume/classification.h.
FV_CONSTANT float kMaxExtinction = 1e30f;

// Must equal the constants of engine/scene/lighting.h.
FV_CONSTANT float kHighlight = 0.2f;
FV_CONSTANT float kHighlightExponent = 40.0f;

// Least squared distance to a source, in squared edges of a block: the mean of 1 / distance² over a ball of
// the block's volume is 1 over this. So a source inside a block lights it no more than that.
FV_CONSTANT float kNearestLight2 = 0.1283f;

FV_CONSTANT int kCodeDepth8 = 0;
FV_CONSTANT int kCodeLinear8 = 1;
FV_CONSTANT int kFilterGeometric = 0;
FV_CONSTANT int kFilterArithmetic = 1;
FV_CONSTANT int kLookupBilinear = 0;
FV_CONSTANT int kLookupNearest = 1;
FV_CONSTANT int kLookupExact = 2;  // of lights: along rays that were swept from them
FV_CONSTANT int kLookupNone = 3;   // A = 1
FV_CONSTANT int kCompositeNormalised = 0;
FV_CONSTANT int kCompositeAdditive = 1;
FV_CONSTANT int kCompositeSorted = 2;

// One level of the octree: engine/octree/hierarchy_layout.h.
struct BlockLevel {
  uint first;       // index of its first block
  uint firstRank;   // rank of its first occupied block
  uint firstBound;  // offset of its bounds in a plane of the table
  int rowPitch;
  ivec3 dimensions;
};

// The step to a level of the octree from the one below.
struct LevelStep {
  BlockLevel child, parent;
  uvec2 parents;     // device address of the parents' indices, ascending
  uint parentCount;  // blocks of the parent level that hold anything
  uint parentWords;  // occupancy words of the parent level
  int childEdge;     // voxels along a child's edge
};

// The levels that a dispatch computes: `first` to `end` - 1.
struct LevelRange {
  int first, end;
};

// Device addresses of the medium of occupied blocks (engine/octree/device_volume.h); 0 if it does not exist.
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

// The planes that a dispatch of a sweep marches through, in the order of the march
// (engine/attenuation/slabs.h).
struct SweepSlab {
  int firstPlane, endPlane;
  int firstQuad;     // index of the slab's first quad among all quads of voxels
  uint firstDepth;   // index of this direction's first depth between slabs
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
  int marchStride;   // offset to the next plane; negative when marching down
  float stepLength;  // world length of a lattice step
};

// attenuation_sweep_half.comp. Offsets and strides are in voxels of the padded grid.
struct HalfSweepPush {
  SweepSlab slab;
  int rowPitch, start;                     // start: offset of the row at plane 0, side 0
  int marchCount, marchStride, marchStep;  // extent, stride and step of the march axis; step -2, -1, 1 or 2
  int sideCount, sideStride, sideStep;     // those of the axis that is neither x nor the march axis
  float stepLength;                        // world length of half a step: of one layer
  ivec2 halfway[4];                        // rows around the middle of a step: offsets on the march and side axes
};

// engine/scene/source_rays.h documents the members.
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
  uvec2 depths;  // device address: for each k and ray, sqrt(depth / kOpaqueDepth) of planes 2k and 2k + 1, 16 bits each
};

// A bit for each of kBlocksPerWord blocks that says whether it is occupied, and the number of occupied blocks
// of the level before them. Data of blocks are stored at their ranks: the occupied blocks in order, level by
// level.
struct OccupancyWord {
  uint mask;
  uint before;
};

// Planes `begin` to `end` - 1 of a face, counted from its first, of which ray_sweep.comp has the extinction.
// The voxel of plane k with the coordinates a and b on the sides of the face is at
//   origin + k planeStride + a strideA + b strideB.
struct RaySlab {
  int begin, end;
  int origin, planeStride, strideA, strideB;
};

// ray_sweep.comp
struct RaySweepPush {
  FaceRays fan;
  mat3 indexToWorld;
  ivec2 sides;  // the volume's dimensions on the sides of the face
  RaySlab slab;
};

// medium_level.comp
struct MediumLevelPush {
  BlockStores stores;
  LevelRange levels;
  ivec3 voxels;        // the volume's dimensions
  float voxelLength;   // world length of a voxel's edge
  uint firstColor;     // rank of the first block with a colour: of level 1
};

// table_level.comp
struct TableLevelPush {
  LevelRange levels;
  ivec3 voxels;
  uint firstDirection, directionCount;  // in the order of directions.h
};

// cut_select.comp: constants of all levels of a frame. Positions are relative to the volume's middle.
struct CutFrame {
  BlockLevel levels[kMaximumLevels];
  uint coarseFirst;       // rank of the first block above the voxels
  int top;                // the coarsest level of the octree
  int finest;             // no level below is drawn
  int coarsest;           // no level above is drawn
  vec3 middle;            // of the volume, index space
  vec3 viewAxis;          // distance from the eye plane: viewAxis . position + middleDistance
  float middleDistance;
  float edgePerDistance;  // a block is small if its edge, in voxels, is at most this times its distance
  vec4 planes[5];         // a box is visible if planes.xyz . centre + planes.w + |planes.xyz| . half edges >= 0
  int outside;            // whether to leave out blocks outside of the image
  int hides;              // whether to leave out hidden blocks
  float darkDepths[kMaximumCells];  // by cell number: least stored depth that hides, for a line of sight of length 1
  // As in SetupFrame:
  mat3 indexToWorld;
  vec3 eyeToMiddle;
  vec3 ray;
  int orthographic;
  int pathLengthCorrection, cells;
  vec3 axisLengths;       // world lengths of the index axes
};

// cut_select.comp and cut_write.comp, one level of the cut
struct CutPush {
  int level;
  uint slotCount;      // eight for each block of the list of the level above
  uint firstGroup;     // index of this level's first workgroup among those of all drawn levels
};

// Counts of cut_select.comp, of blocks whose parent was opened.
struct CutCounts {
  uint empty;          // not occupied
  uint outside;        // occupied, but outside of the image
  uint hidden;         // inside the image, but hidden
  uint opened;         // not left out, but replaced by their children
};

// expand_voxels.comp
struct ExpandPush {
  BlockLevel voxels;
  ivec3 first;   // first voxel, whose x is a multiple of 4; may be outside of the volume
  ivec3 extent;  // in quads along x
};

// occupied_blocks.comp
struct OccupiedBlocksPush {
  LevelRange levels;
};

// compact_count.comp, compact_scan.comp, compact_write.comp
struct CompactPush {
  uint firstWord;    // index of the level's first occupancy word
  uint wordCount;
  uint groupCount;   // number of workgroups of the count and write passes
  uint chunkCount;   // compact_scan.comp: whose arguments it writes
  uvec2 blocks;      // device address of the list that compact_write.comp writes
};

// Arguments of a chunk, in the order of vkCmdDispatchIndirect and vkCmdDrawIndirect.
struct ChunkArguments {
  uint groupsX, groupsY, groupsZ;
  uint splatCount, firstSplat;  // of the list
  uint vertexCount, instanceCount, firstVertex, firstInstance;              // points: one vertex for each splat
  uint quadVertexCount, quadInstanceCount, quadFirstVertex, quadFirstInstance;  // quads: one instance for each splat
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
  uint shift;  // bits below the digit of this pass
};

#ifdef __cplusplus
static_assert(sizeof(CutFrame) <= 16384);  // the largest uniform buffer that every device supports
}  // namespace freevoxels::shader
#endif
#endif
