#ifndef FREEVOXELS_GATHER_INTERFACE_H
#define FREEVOXELS_GATHER_INTERFACE_H
// What C++ and the shaders of the gather share: engine/gathering/gather_pass.h describes the passes.
#include "frame_interface.h"

#ifdef __cplusplus
namespace freevoxels::shader {
#endif

FV_CONSTANT int kGatherTile = 8;          // samples along the edge of a workgroup of the passes over the lattice
FV_CONSTANT int kShadeThreads = 64;
// The gather reads blocks in bricks of 8^3, which are cells of the octree so many levels above.
FV_CONSTANT int kBrickLevels = 3;
FV_CONSTANT int kGatherBrickEdge = 1 << kBrickLevels;
FV_CONSTANT int kGatherBrickBlocks = kGatherBrickEdge * kGatherBrickEdge * kGatherBrickEdge;
// Where there is nothing rays skip cells, so many levels above; as many slices as a cell has blocks along an edge are
// tested together.
FV_CONSTANT int kSkipLevels = 2;
FV_CONSTANT int kSkipGroup = 1 << kSkipLevels;
FV_CONSTANT int kBrickQuadsThreads = kGatherBrickEdge * kGatherBrickEdge;
// Quads of more bricks than one texel buffer or allocation holds are in pieces of so many.
FV_CONSTANT int kPieceBricksLog2 = 17;
FV_CONSTANT int kMostPieces = 32;
// Lights whose transmittance is found at samples, from quads of optical depths towards them.
FV_CONSTANT int kMostSampleLights = 4;
// Quads of codes of light: a slot a light, then one for each channel of light from everywhere.
FV_CONSTANT int kMostLightSlots = kMostSampleLights + 3;
FV_CONSTANT int kAmbientThreads = 64;
// Classification after interpolation: a transfer function's intervals of the scalar, and the codes of scalars, 1 and above.
FV_CONSTANT int kTransferIntervals = 4096;
FV_CONSTANT int kScalarCodes = 65534;

// Variance in voxels, squared, of the footprint's radial kernel along one axis; a slice's tent lacks it along the tilt.
FV_CONSTANT float kFootprintVariance = 0.1624f;

// Rays march along the major axis of the image's middle unless the component along it is less than this part of their
// largest one: so that a frame mostly reads one axis. And how many slices such rays then test together, as they move by
// more than a block a slice.
FV_CONSTANT float kLeastAlong = 0.5f;
FV_CONSTANT int kObliqueGroup = kSkipGroup / 2;

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
  uvec2 mediumPieces[kMostPieces], sourcePieces[kMostPieces], towardsPieces[kMostPieces];  // device addresses of quads
  uvec2 lightPieces[kMostLightSlots][kMostPieces];
  ivec2 slices[2][kMaximumLevels];  // by the ray's sign along the axis (0: descending) and level: first, end; ascending
};

// One level of the octree as the gather reads it. Brick numbers are those of the quads; 0 is empty.
struct GatherLevel {
  ivec3 dimensions;     // blocks
  int firstCell;        // of the table of brick numbers
  ivec2 cellStrides;    // in that table, of y and z
  int firstSkip;        // of the table of cells to skip: 0, or how many groups of slices nothing is met in
  ivec2 skipStrides;    // in that table, of y and z
  ivec3 lastSkip;       // the last cell
};

// A light whose transmittance is found at samples.
struct SampleLight {
  vec3 place;          // at infinity the direction towards it, in the world and of length 1; else index space
  int atInfinity;
  vec3 color;          // times the irradiance, of a position at distance 1
  vec3 across;         // at infinity the direction towards it in index space, across a layer of voxels
};

struct GatherFrame {
  SampleLight lights[kMostSampleLights];
  vec3 tint;              // of the extinction, on the way of the light
  float phaseG;
  float surface;          // how much of the lights is scattered as by surfaces
  float nearestLight2;    // squared distance, world units, that a light has at least
  vec3 ambient;           // mean radiance over all directions, and all octaves of scattering
  float octaveScale;      // of an octave to the one before
  mat3 indexToWorld;      // linear part
  mat3 gradientToWorld;
  uvec2 gradients;        // device address: of surface_gradients.comp
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
  uvec2 blocks;      // device addresses: of the level's list of occupied blocks,
  uvec2 sources;     // and by rank, of packed source term and extinction as a half,
  uvec2 towards;     // and of what depends on the direction to the eye
  uint firstRank;
  uint count;
  float extinctionScale, sourceScale;  // from per world unit to what is stored
  float meanLayer;   // world length that light crosses in a voxel, mean over directions
  int lightOnly;     // 1: the source term is that of extinction and colour 1
};

// expand_scalars.comp
struct ExpandScalarsPush {
  ivec3 first;       // voxel, whose x is a multiple of 4; may be before those of the volume
  ivec3 extent;      // in quads along x
  ivec3 dimensions;  // of the volume
  ivec3 corner;      // place of the volume's first voxel in its brick of scalars
  ivec3 cells;       // bricks of scalars along the axes
  uvec2 bricks, codes;  // device addresses of the bricks' numbers by cell, and of 16 bits a voxel
};

// Codes of 16 bits a block, in bricks: of scalars, or of depths towards a light.
struct CodeBricks {
  uvec2 numbers, codes;  // device addresses: of the bricks' numbers by cell, of which 0 is empty, and of the codes
  ivec3 corner;          // place of the first block in its brick
  ivec3 cells;           // bricks along the axes
};

// surface_gradients.comp
struct SurfaceGradientsPush {
  BlockLevel level;
  uint firstBrick;
  uint count;         // of bricks
  uvec2 extinction;   // device addresses: by rank, and of the gradients, 4 bytes a block in bricks, x fastest
  uvec2 gradients;
  CodeBricks scalars; // of the finest level
};

// light_depths.comp
struct LightDepthsPush {
  BlockLevel level;
  uint firstBrick;
  uint count;        // of bricks
  int light;         // among all
  int edge;          // of a block, voxels
  ivec3 voxels;      // the volume's dimensions
  mat3 indexToWorld; // linear part
  uvec2 extinction;  // device addresses: by rank, and of the depths, 16 bits a block in bricks, x fastest
  uvec2 depths;
};

// ambient_sweep.comp
struct AmbientSweepPush {
  ivec3 cells;
  ivec3 step;        // from cell to cell, the way of the light
  float stepLength;  // world units
  vec3 share;        // of the unshadowed light that comes from this direction, by channel
  float weight;      // part of the sphere that the direction stands for, over the sum of all octaves
  int octaves;       // of scattering
  float octaveScale;
  float phaseG;
  mat3 cellToWorld;  // linear part
  vec3 eye;          // cells; orthographic the direction towards it
  int orthographic;
  vec3 tint;         // of the extinction, by channel
};

// ambient_codes.comp
struct AmbientCodesPush {
  ivec3 cells;
  int cellEdge;      // voxels
  int blockEdge;     // voxels
  int firstLight;    // of the channel
  int firstWeight;   // of what the light is divided by; -1: of nothing
  uint firstBrick;
  uint count;        // of bricks
  uvec2 codes;       // device address: 16 bits a block in bricks, x fastest
};

// brick_quads.comp
struct BrickQuadsPush {
  BlockLevel level;
  uint firstBrick;
  uint count;        // of bricks
  uint firstQuad;    // where they begin at the addresses
  uvec2 medium, source, towards;  // device addresses of quads
  uvec2 sources, towardsEye;        // device addresses: what shade_blocks.comp made, by rank
  CodeBricks codes;
};

#ifdef __cplusplus
static_assert(sizeof(GatherFrame) <= 16384);
static_assert(sizeof(SurfaceGradientsPush) <= 128);
}  // namespace freevoxels::shader
#endif
#endif
