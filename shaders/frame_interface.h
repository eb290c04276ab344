#ifndef FREEVOXELS_FRAME_INTERFACE_H
#define FREEVOXELS_FRAME_INTERFACE_H
// Structs that C++ and the shaders of a frame share: lights, splats, resolve. interface.h has those of the
// volume.
#include "interface.h"

#ifdef __cplusplus
namespace freevoxels::shader {
#endif

// A splat that is ready to draw: written by splat_setup.comp, read by splat.vert.
struct Splat {
  vec4 colorEnergy;   // e_v c_v and e_v without the transmittance to the eye, times the footprint's peak
  vec2 center;        // pixels from the middle of the image
  vec2 halfExtent;    // in pixels; 0 if the splat is not drawn
  vec3 conic;         // xx, xy, yy: (r/R)² |D|² = xx dx² + 2 xy dx dy + yy dy² at (dx, dy) from the centre
  float opticalDepth; // t_v times the footprint's peak, per world length of the ray; negative if the eye plane cuts the kernel
  float distance;     // from the eye plane along the viewing axis, world units
  vec3 depthToEye;    // depth at the voxel's centre, and its change per pixel along x and y
  // If the eye plane cuts the kernel, with q from the eye to its centre in index space: `conic` is q . D of
  // the middle of the image and its change per pixel along x and y; `depthToEye` is the depth at the eye, its change
  // per world length along the ray, and |q|².
};

// lighting.glsl
struct Light {
  vec3 place;         // from the volume's middle, index space; at infinity the direction towards the light, of which
                      // the largest component is 1
  int atInfinity;
  vec3 color;         // includes the intensity
  uvec2 beyond;       // device address of the output of eye_depths.comp; 0 if the light is outside of the volume
  FaceRays fans[6];   // kLookupExact: rays from the light, by fanIndex; at infinity six times the same
};

// Codes of 16 bits a block, in bricks: of scalars, or of depths towards a light.
struct CodeBricks {
  uvec2 numbers, codes;  // device addresses of the bricks' numbers by cell (0 is the empty brick) and of the codes
  ivec3 corner;          // position of the first block in its brick
  ivec3 cells;           // number of bricks along the axes
};

// Light that was scattered before, comes from the surroundings or is emitted (scattered_light.glsl).
struct ScatteredGrid {
  uvec2
      texels;  // device address: `moments` vec4 by cell, x fastest: the mean radiance, and its flux along x, y and z; 0 without such light
  ivec3 cells;
  mat3 toCells;  // from the middle of a voxel plus a half, in index space, to cells: toCells * (voxel + 0.5) + firstCell
  vec3 firstCell;
  float share;     // of this light that is scattered out of its direction
  float flux;      // factor of the flux towards the eye
  int moments;
};

// The lighting of a frame.
struct FrameLighting {
  int lightCount;
  int lookup;                    // kLookup... for the transmittance to lights
  vec3 tint;                     // factor of the extinction between light and voxel
  float forward;                 // fraction of what is scattered that counts as not scattered
  vec3 deltaScale;               // mean factor of the extinction of light that this makes
  float phaseG;
  float surface;                 // fraction of the lights that is reflected like a surface
  ScatteredGrid scattered;
  mat3 gradientToWorld;
  CodeBricks scalars;  // of voxels, whose gradients are the normals of surfaces; codes at address 0: extinctions' are
};

// The constants of a frame. Index space is relative to the middle of the volume, so that 32-bit floats keep
// their precision far from the origin.
struct SetupFrame {
  mat3 indexToWorld;       // linear part
  // Pixels are counted from the middle of the image, too.
  mat3 indexToPixel;       // index offset -> (x t, y t, t), orthographic (x, y, t): see PixelRays for x, y and t
  vec3 middle;             // of the volume, index space
  vec3 eyeToMiddle;        // from the ray origin, index space
  vec3 middleInPixels;     // indexToPixel * eyeToMiddle
  vec3 pixelX, pixelY;     // how the ray moves with x and y: its direction, or orthographic its origin; index space
  vec3 ray;                // of the middle of the image, index space; orthographic: all rays have its direction
  vec2 imageSize;          // pixels
  int orthographic;
  ivec3 dimensions;
  BlockLevel levels[kMaximumLevels];
  BlockStores stores;
  int levelCount;
  float voxelSize;         // edge of the cube with a voxel's volume, world units
  int lookup;              // kLookup... for the transmittance to the eye
  uvec2 sourceDepth;         // device address of the output of eye_depths.comp; 0 if the eye is outside of the volume
  int pathLengthCorrection;  // 0 if every lattice step has the same length
  int kernelMean;          // 1 if a voxel has the mean transmittance over its kernel along the line of sight
  int gradient;            // 0 if the transmittance to the eye is constant over a footprint
  int code;                // kCode...
  int cells;               // that the table's directions divide the cube's half edge into
  vec3 albedo;
  float emissionUnit;  // radiance per world unit of a stored 1
  FrameLighting lighting;
};

struct SetupPush {
  uint chunk;
};

// eye_depths.comp
struct EyeDepthsPush {
  BlockLevel voxels;
  BlockStores stores;
  vec3 place;        // position of the eye, index space, clamped to the box of the voxels' centres
  int cells;         // that the table's directions divide the cube's half edge into
  int first;         // index of the first depth; depths are by cell number
};

// splat.vert and splat.frag
struct SplatPush {
  vec2 imageMiddle;        // pixels
  vec3 rayLength2;         // |D|² of the pixel ray in index space at (x, y) from the middle: rayLength2 . (1, x, y)
  vec3 rayLength2Squares;  //   + rayLength2Squares . (x², xy, y²)
  vec3 worldLength2;       // the same in world space
  vec3 worldLength2Squares;
  vec2 viewportSize;  // of the enlarged viewport around the same middle, in pixels
};

// resolve.comp. Rays are counted from the middle of the image.
struct ResolvePush {
  vec3 ray, rayX, rayY;                  // index space
  vec3 worldRay, worldRayX, worldRayY;   // in world space
  ivec2 size;
  int composite;                         // kComposite...
};

#ifdef __cplusplus
}  // namespace freevoxels::shader
#endif
#endif
