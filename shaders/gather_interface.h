#ifndef FREEVOXELS_GATHER_INTERFACE_H
#define FREEVOXELS_GATHER_INTERFACE_H
// What C++ and the shaders of the gather share: engine/splatting/gather_pass.h describes the passes.
#include "frame_interface.h"

#ifdef __cplusplus
namespace freevoxels::shader {
#endif

FV_CONSTANT int kGatherTile = 8;          // samples along the edge of a workgroup of the passes over the lattice
FV_CONSTANT int kShadeThreads = 64;
// The gather reads blocks in bricks of 8^3, which are cells of the octree so many levels above. A ray tests as many slices
// as a brick has blocks along an edge for emptiness together.
FV_CONSTANT int kSkipLevels = 3;
FV_CONSTANT int kGatherGroup = 1 << kSkipLevels;
FV_CONSTANT int kGatherBrickBlocks = kGatherGroup * kGatherGroup * kGatherGroup;
FV_CONSTANT int kBrickQuadsThreads = 64;
// Variance in voxels, squared, of the footprint's radial kernel along one axis; a slice's tent lacks it along the tilt.
FV_CONSTANT float kFootprintVariance = 0.1624f;

// Rays march along the major axis of the image's middle unless the component along it is less than this part of their
// largest one: so that a frame mostly reads one axis. And how many slices such rays then test together, as they move by
// more than a block a slice.
FV_CONSTANT float kLeastAlong = 0.5f;
FV_CONSTANT int kObliqueGroup = 4;

// How rays meet the slices of blocks across one index axis. Pixel positions (x, y) are relative to the image's middle.
// The sides are the other two axes in ascending order. All are affine: value . (1, x, y).
struct GatherAxis {
  vec3 along;          // component of the ray's direction along the axis, per world unit of distance from the eye plane
  vec3 eye;            // position of the ray's start along the axis, voxels
  vec3 slope[2];       // change of the sides' positions per slice, times `along`
  vec3 middle[2];      // the sides' positions in the plane at `middlePlane`, times `along`
  vec2 tilt;           // what a step along the axis is on the image, in pixels times distance, at the image's middle
  float tiltDepth;     // change of the distance by that step
  float middlePlane;   // voxels
  ivec2 slices[2][kMaximumLevels];  // by the ray's sign along the axis (0: descending) and level: first, end; ascending
};

// One level of the octree as the gather reads it. Brick numbers are those of the quads; 0 is empty.
struct GatherLevel {
  ivec3 dimensions;     // blocks
  int firstCell;        // of the table of brick numbers
  ivec3 cellStrides;    // in that table
  ivec3 lastCell;
};

struct GatherFrame {
  GatherAxis axes[3];
  GatherLevel levels[kMaximumLevels];
  int finest, coarsest;   // levels that are read
  vec3 worldRay[3];       // the ray's direction in the world: worldRay[0] + x worldRay[1] + y worldRay[2]
  ivec2 samples;          // of the lattice
  ivec2 size;             // of the image, pixels
  vec2 firstSample;       // position of sample (0, 0), pixels from the image's middle
  float pitch;            // pixels between neighbouring samples
  float pixelsPerVoxel;   // at distance 1, or orthographic anywhere
  float extinctionUnit;   // per world unit that a stored extinction of 1 is
  float sourceUnit;       // radiance per stored source term over stored extinction
  vec3 color;             // source term over extinction where all blocks have the same
  float end;              // transmittance at which rays end
  int orthographic;
  int mainAxis;           // the major axis of the ray in the image's middle
  vec2 seenLow, seenHigh; // positions between which all rays are that meet the volume
};

// shade_blocks.comp
struct ShadePush {
  uint firstRank;
  uint count;
  float extinctionScale, sourceScale;  // from per world unit to what is stored
  float meanLayer;   // world length that light crosses in a voxel, mean over directions
};

// brick_quads.comp
struct BrickQuadsPush {
  BlockLevel level;
  uint firstBrick;   // of the level
  uint count;        // quads of the level
};

// skip_cells.comp
struct SkipCellsPush {
  BlockLevel level;
  uint firstCell;    // address of the first block of the finest level with cells
  uint count;        // addresses of the level
};

#ifdef __cplusplus
static_assert(sizeof(GatherAxis) == 8 * 4 + 12 * 6 - 16 + 2 * kMaximumLevels * 8);
static_assert(sizeof(GatherLevel) == 40);
static_assert(sizeof(BrickQuadsPush) == 36);
static_assert(sizeof(GatherFrame) <= 16384);
static_assert(sizeof(ShadePush) == 20);
static_assert(sizeof(SkipCellsPush) == 36);
}  // namespace freevoxels::shader
#endif
#endif
