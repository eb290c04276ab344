#ifndef FREEVOXELS_SHARE_INTERFACE_H
#define FREEVOXELS_SHARE_INTERFACE_H
// What C++ and the shaders of a frame that is drawn share by share have in common.
#include "frame_interface.h"

#ifdef __cplusplus
namespace freevoxels::shader {
#endif

// Binary digits of a value that is added to the sums: kValueBits of engine/image/fixed_sums.h.
FV_CONSTANT int kSumBits = 55;

// share_key.comp: the octree, and where the shares of each level's chunks begin.
struct ShareFrame {
  BlockLevel levels[kMaximumLevels];
  uint firstChunks[kMaximumLevels];
  int levelCount;
  int chunkLevels;       // a chunk of level l is what a block of level l + chunkLevels covers
};

// share_key.comp
struct ShareKeyPush {
  uint chunkCount;       // chunks of the list of drawn blocks
};

// Workgroups of accumulate_sums.comp, each of which takes one tile after the other: as many as every device dispatches.
FV_CONSTANT int kMaxTileGroups = 65535;

// The arguments of the dispatch of accumulate_sums.comp, and the length of its list of tiles of kResolveTile x kResolveTile pixels.
struct TileArguments {
  uint groupsX, groupsY, groupsZ;
  uint tileCount;
};

// mark_tiles.comp
struct MarkPush {
  uint chunk;            // of the splats
  vec2 imageMiddle;      // pixels
  ivec2 tiles;           // of the image
};

// accumulate_sums.comp
struct AccumulatePush {
  ResolvePush rays;
  ivec2 first, extent;   // the rectangle of the image that has sums
  int colorDigits, energyDigits, depthDigits, distanceDigits;  // behind the binary point
  uvec2 sums;            // device address of the sums: [channel][pixel of the rectangle], low word and high word
};

#ifdef __cplusplus
static_assert(sizeof(AccumulatePush) <= 128);  // that every device takes
}  // namespace freevoxels::shader
#endif
#endif
