#ifndef FREEVOXELS_GATHER_INTERFACE_H
#define FREEVOXELS_GATHER_INTERFACE_H
// Structs and constants that C++ and the shaders of the gather share. engine/gathering/gather_pass.h
// describes the passes.
#include "frame_interface.h"

#ifdef __cplusplus
namespace freevoxels::shader {
#endif

FV_CONSTANT int kGatherTile = 8;          // samples along the edge of a workgroup of the passes over the lattice
FV_CONSTANT int kShadeThreads = 64;      // of a workgroup of shade_blocks.comp
FV_CONSTANT float kMaxStored = 65280.0f;  // largest stored extinction, a half, and packed light
// The gather reads blocks of all levels in bricks of 8^3.
FV_CONSTANT int kGatherBrickEdge = 1 << kBrickLevels;
FV_CONSTANT int kGatherBrickBlocks = kGatherBrickEdge * kGatherBrickEdge * kGatherBrickEdge;
// Rays skip empty cells, which are this number of levels above the blocks. As many slices are tested together
// as a cell has blocks along an edge.
FV_CONSTANT int kSkipLevels = 2;
FV_CONSTANT int kSkipGroup = 1 << kSkipLevels;
FV_CONSTANT int kBrickQuadsThreads = kGatherBrickEdge * kGatherBrickEdge;
// Quads of more bricks than a texel buffer or allocation can hold are split into pieces of this number of
// bricks.
FV_CONSTANT int kPieceBricksLog2 = 17;
FV_CONSTANT int kMaxPieces = 32;
// Largest number of lights that are evaluated at samples, from quads of optical depths.
FV_CONSTANT int kMaxSampleLights = 4;
// GatherFrame::projection
FV_CONSTANT int kMaxIntensity = 1;
FV_CONSTANT int kAverageIntensity = 2;
// For classification after interpolation: the number of the transfer function's intervals of the scalar, and
// that of the codes of scalars, which start at 1.
FV_CONSTANT int kTransferIntervals = 4096;
FV_CONSTANT int kScalarCodes = 65534;

// Variance in squared voxels of the footprint's radial kernel along one axis. A slice's bilinear tent has it across the slice and none
// along its normal, so that it is too narrow where it is seen obliquely (engine/docs/gather.md).
FV_CONSTANT float kFootprintVariance = 0.1624f;
// Largest variance that the stencil adds, in squares of the pitch: beyond it the middle weight would be nearly 0.
FV_CONSTANT float kMaxVariance = 0.8f;
// Samples in front of the first row and column of pixels: the first pixel's middle is sample kLatticeMargin.
FV_CONSTANT int kLatticeMargin = 1;
// Least distance between samples in pixels: what is smaller is averaged by four rays a pixel and those on its borders.
FV_CONSTANT float kMinPitch = 0.5f;
// Samples along an axis of the image of which a pixel is made: those that Catmull-Rom interpolation reads anywhere in the pixel. Six are
// enough for any pitch, which is at least kMinPitch, five for one of at least a pixel.
FV_CONSTANT int kResampleTaps = 6;
FV_CONSTANT int kSparseResampleTaps = 5;
// Samples of less energy, which may be no more than rounding, do not widen the range of mean distances around them.
FV_CONSTANT float kMinRangeEnergy = 1e-6f;
// Least transmittance that the stencil distinguishes from 0.
FV_CONSTANT float kMinTransmittance = 1e-6f;

// A ray marches along the major axis of the image's middle, unless its component along that is less than this
// fraction of its largest component: so most frames read one axis.
FV_CONSTANT float kMinAlong = 0.5f;
// LevelGeometry that are tested for emptiness together on rays that move by more than a block a slice, instead of kSkipGroup.
FV_CONSTANT int kObliqueGroup = kSkipGroup / 2;

// How rays meet the slices of blocks across one index axis. Pixel positions (x, y) are relative to the
// image's middle. The sides are the other two axes in ascending order. Values are affine in the position:
// value . (1, x, y).
struct GatherAxis {
  vec3 along;          // component of the ray's direction along the axis, per world unit of distance from the eye plane
  vec3 eye;            // position of the ray's start along the axis, voxels
  vec3 slope[2];       // change of the sides' positions per slice, times `along`
  vec3 middle[2];      // the sides' positions in the plane at `middlePlane`, times `along`
  vec2 tilt;           // projection of a step along the axis to the image, in pixels times distance, at the image's middle
  float tiltDepth;     // change of the distance by that step
  float middlePlane;   // voxels
  uvec2 mediumPieces[kMaxPieces], sourcePieces[kMaxPieces], extraPieces[kMaxPieces];  // device addresses of quads
  uvec2 lightPieces[kMaxSampleLights][kMaxPieces];
  ivec2 slices[2][kMaximumLevels];  // by the ray's sign along the axis (0: descending) and level: first and end, ascending
};

// A level of the octree for the gather. Brick numbers are those of the quads; 0 is empty.
struct GatherLevel {
  ivec3 dimensions;     // blocks
  int firstCell;        // first entry in the table of brick numbers
  ivec2 cellStrides;    // in that table, of y and z
  int firstSkip;        // first entry in the table of cells to skip, which has 0, or the number of empty groups of slices
  ivec2 skipStrides;    // in that table, of y and z
  ivec3 lastSkip;       // the last cell
};

// A light that is evaluated at samples.
struct SampleLight {
  vec3 positionOrDirection;  // position in index space; at infinity the unit vector towards the light in world space
  int atInfinity;
  vec3 color;          // colour times irradiance, for a position at distance 1
  vec3 across;         // at infinity the direction towards it in index space, of the length of a layer
  // By axis: 1 if its light arrives at the volume's first or last border from beyond that border, else 0.
  vec3 lightsFirst, lightsLast;
};

// A cube of a volume whose voxels alone are on the device (engine/cube_drawing.h): rays march what is in it, behind the cubes that
// were marched before, of which the sums of the lattice hold the results. Positions on rays are those in the whole volume.
struct GatherCube {
  ivec3 first;            // first voxel of the box around the cube, whose bricks and cells the levels number; a multiple of a brick's edge
  ivec3 begin, end;       // the cube has the quads of the voxels from `begin` to `end` - 1
  ivec2 corner, extent;   // the rectangle of the lattice from which the cube is seen
  int isLast;             // 1 if the sums are then complete
};

// Ranges of the list of samples that are marched: a dispatch each, so that a frame can be abandoned between them.
FV_CONSTANT int kSampleRanges = 8;

struct DispatchSize {
  uint x, y, z;  // workgroups
};

// In front of a list of the places in the lattice of samples that are marched: the sizes of the indirect dispatches of its ranges, whose
// rows of workgroups have all the same length, and the number of samples.
struct SampleListHead {
  DispatchSize ranges[kSampleRanges];
  uint count;
};

// Tiles of the samples that are seen, from the first one on. The image is drawn from those that hold anything and those beside them.
FV_CONSTANT int kLatticeTile = 16;         // samples along an edge, a multiple of kGatherTile
FV_CONSTANT int kTilesOfARange = 1 << 12;  // tiles of an indirect dispatch over the list

struct DrawSize {  // as VkDrawIndirectCommand
  uint vertices, instances, firstVertex, firstInstance;
};

// Of an entry of the list of tiles: whether the tiles beside it are listed, too, and above these bits the number of the tile.
FV_CONSTANT uint kLeftIsListed = 1u;
FV_CONSTANT uint kRightIsListed = 2u;
FV_CONSTANT uint kUpperIsListed = 4u;
FV_CONSTANT uint kLowerIsListed = 8u;
FV_CONSTANT int kTileShift = 4;

// gather_stencil.comp
struct TilesPush {
  int firstOfRange;  // first entry of the list of the tiles
};

// gather_tiles.vert, gather_resample.frag
struct ResamplePush {
  int firstRow, endRow;      // rows of the lattice that the image of rows holds, the first one as its row 0
  int firstPixel, endPixel;  // rows of pixels that are drawn of these
  ivec2 target;              // size of the image that is drawn into
};

// Which samples of the lattice a dispatch of gather.comp marches.
struct SamplesPush {
  uvec2 list;        // device address of the list that is marched if `step` is 0
  int step;          // otherwise every `step`-th sample along both axes is
  int groupsOfARow;  // length of a row of workgroups in the list
  int rowsOfARange;  // number of rows of workgroups in each range of the list
  int firstRow;      // first row of the range that is marched
  int groups;        // number of workgroups that list samples
  // Of a frame of several volumes (MergeFrame), otherwise 0:
  int columns;          // samples of a row that are dispatched, without a list
  int slots;            // number of rays of the dispatch, for which there is room in slabs
  int volume;           // the number of the volume
  int slabs;         // number of slabs, and so of entries for which a volume has room
  uvec2 merge, rays;              // device addresses: MergeFrame; the volumes that the ray of each slot meets, a bit for each;
  uvec2 entries, counts, depths;  // what the volumes have in slabs (gather_slabs.glsl)
};

// Several volumes in one image (engine/gathering/merged_pass.h). What each has along a ray is added up in slabs: between planes parallel
// to the image, at equal distances within each interval.
FV_CONSTANT int kMaxMerged = 32;
FV_CONSTANT int kMaxSlabIntervals = 2 * kMaxMerged;
FV_CONSTANT int kMaxSlabs = 1 << 12;

struct MergedBox {
  vec3 origin[3];     // the ray of the position p = (1, x, y) on the image: component c of its origin in index space is origin[c] . p,
  vec3 direction[3];  // and of its way for a distance of 1 from the eye plane direction[c] . p
  ivec3 dimensions;   // voxels
};

struct SlabInterval {
  float begin, end;  // distances from the eye plane
  float perUnit;     // slabs per unit of distance
  float first;       // number of its first slab
};

struct MergeFrame {
  int volumes, intervals;
  SlabInterval interval[kMaxSlabIntervals];  // in ascending order
  MergedBox boxes[kMaxMerged];
};

// other_depths.comp
struct OtherVolume {
  mat3 toOther;  // from the index space of the volume to that of the other one: toOther * position + offset
  vec3 offset;
  ivec3 dimensions;  // of the other one
};
struct OtherDepthsPush {
  uint firstBrick;
  uint count;          // of bricks
  int light;           // index of the light
  int edge;            // of a block, voxels
  ivec3 voxels;        // the volume's dimensions
  uvec2 depths, rays;  // device addresses: of the volume's codes of depths; of all rays of the light through the other volume
};

struct GatherFrame {
  GatherCube cube;  // only where it is specialised for cubes
  SampleLight lights[kMaxSampleLights];
  vec3 tint;              // factor of the extinction between light and voxel
  float forward;          // fraction of what is scattered that counts as not scattered, on the way to the eye
  vec3 deltaScale;        // mean factor of the extinction that this makes
  ScatteredGrid scattered;  // whose texels are bound
  float phaseG;
  float surface;          // fraction of the lights that is reflected like a surface
  float nearestLight2;    // least squared distance to a light that counts, in world units
  mat3 indexToWorld;      // linear part
  mat3 gradientToWorld;
  uvec2 gradients;        // device address of the output of surface_gradients.comp
  GatherAxis axes[3];
  GatherLevel levels[kMaximumLevels];
  int finest, coarsest;   // range of the levels that are read
  vec3 worldRay[3];       // the ray's direction in world space: worldRay[0] + x worldRay[1] + y worldRay[2]
  ivec2 samples;          // of the lattice
  ivec2 size;             // of the image, pixels
  vec2 firstSample;       // position of sample (0, 0), pixels from the image's middle
  float pitch;            // pixels between neighbouring samples
  float sampleTolerance;  // largest roughness of coarse samples between which others are interpolated (gather_roughness.comp); 0 for none
  float distanceTolerance;  // largest second difference of coarse samples' distances for interpolation, world units
  float extinctionUnit;   // extinction per world unit of a stored 1
  float sourceUnit;       // radiance of a source term that equals the stored extinction
  vec3 color;             // source term over extinction, if all blocks have the same
  float endTransmittance; // at which rays end
  int orthographic;
  int mainAxis;           // the major axis of the ray in the image's middle
  vec2 seenLow, seenHigh; // range of pixel positions of the rays that meet the volume
  // The rectangle of samples outside of which all sums are 0, and are neither marched nor stored: `firstSeen` is even and `seenExtent` odd,
  // so that coarse samples are on its borders.
  ivec2 firstSeen, seenExtent;
  ivec2 ownCells;  // first and end of the rows of cells (gather_adaptive.glsl) whose samples are refined, relative to the first one seen
  ivec2 firstPixel, pixelExtent;  // the rectangle of pixels outside of which the image is empty
  int projection;                 // of scalars: 0, kMaxIntensity or kAverageIntensity
  float projectionLayer;          // the transfer function's unit distance times extinctionUnit
  int raysOfPixel;                // with a holdout: along each axis, the samples of a pixel, of which alone it is made; otherwise 0
  uvec2 holdout;                  // with a holdout: device address of the distance from the eye plane at which the rays of each pixel end
  // The weight of stretches of scalars in four parts beside those in two: from 0 to 1 near the diagonals of voxels and their faces
  // (quartersOf).
  float quarters;
  int clips;               // 1 if rays are marched in a part of the volume alone (RayClip, in index space):
  vec3 clipLow, clipHigh;  // in this box,
  vec3 clipNormal;         // and where dot(clipNormal, position) is at most clipDistance
  float clipDistance;
};

// shade_blocks.comp
struct ShadePush {
  uvec2 blocks;      // device addresses: of the level's list of occupied blocks,
  uvec2 sources;     // and by rank, of packed source term and extinction as a half,
  uvec2 extra;       // and of how the source term depends on the direction to the eye, or of packed emission
  uint firstRank;
  uint count;
  float extinctionScale, sourceScale;  // factors from values per world unit to stored values
  float meanLayer;   // mean world length of light in a voxel over all directions
  int lightOnly;     // 1 if the source term is that of extinction and colour 1
  int emissionApart;  // 1 if emission is kept apart from the source term
};

// expand_scalars.comp
struct ExpandScalarsPush {
  ivec3 first;       // first voxel, whose position in its brick along x is a multiple of 4; may be outside of the volume
  ivec3 extent;      // in quads along x
  ivec3 dimensions;  // of the volume
  CodeBricks scalars;
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
  int light;         // index of the light
  int edge;          // of a block, voxels
  ivec3 voxels;      // the volume's dimensions
  mat3 indexToWorld; // linear part
  uvec2 extinction;  // device addresses: of extinctions by rank; of the depths, 16 bits a block in bricks, x fastest; of all rays of the
                     // light
  uvec2 depths, rays;
};

// light_planes.comp: the planes slab.begin to slab.end - 1 of a face of a light's rays.
FV_CONSTANT uint kOtherFan = 0xffffu;  // the code of voxels that the light reaches through another face
struct LightPlanes {
  FaceRays fan;
  RaySlab slab;
  ivec2 sides;       // the volume's dimensions on the sides of the face
  mat3 indexToWorld; // linear part
  vec3 place;        // of the light in index space; at infinity the direction towards it
  int atInfinity;
  int fanIndex;
};
// Planes in one layer of bricks.
struct LightPlanesPush {
  uvec2 rays;                  // device address of the rays' depths
  int firstBrick, brickCount;  // of the bricks that are there
  int firstPlane;
  int firstCode;  // of the first plane, in words
};
FV_CONSTANT int kLightPlanesThreads = 64;
FV_CONSTANT int kLightBrickEdge = 8;  // ScalarBricks::kEdge

// brick_quads.comp
struct BrickQuadsPush {
  BlockLevel level;
  uint firstBrick;
  uint count;        // of bricks
  uint firstQuad;    // index of the first quad
  uvec2 medium, source, extra;  // device addresses of quads
  uvec2 sources, extras;        // device addresses of the output of shade_blocks.comp, or of the volume's extinctions, by rank
  float extinctionScale;        // factor from the volume's extinctions to stored ones
  CodeBricks codes;
};

#ifdef __cplusplus
static_assert(sizeof(GatherFrame) <= 16384);
static_assert(sizeof(SurfaceGradientsPush) <= 128);
static_assert(sizeof(LightDepthsPush) <= 128);
static_assert(sizeof(BrickQuadsPush) <= 128);
static_assert(sizeof(SamplesPush) <= 128);
}  // namespace freevoxels::shader
#endif
#endif
