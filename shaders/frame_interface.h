#ifndef FREEVOXELS_FRAME_INTERFACE_H
#define FREEVOXELS_FRAME_INTERFACE_H
// What C++ and the shaders of a frame share, as interface.h of the volume's: lights, splats, their drawing, the picture.
#include "interface.h"

#ifdef __cplusplus
namespace freevoxels::shader {
#endif

// One splat, ready to draw. Written by splat_setup.comp, pulled by splat.vert.
struct Splat {
  vec4 colorEnergy;   // e_v c_v and e_v without the transmittance to the eye, times the footprint's peak
  vec2 center;        // pixels, (0, 0) = the top left corner of the image
  vec2 halfExtent;    // pixels; 0 = not drawn
  vec3 conic;         // xx, xy, yy: (r/R)² |D|² = xx dx² + 2 xy dx dy + yy dy² at (dx, dy) from the centre
  float opticalDepth; // t_v, times the footprint's peak, per world length of ray; less than 0: the kernel is cut
  float distance;     // from the eye plane along the viewing axis, world units
  vec3 depthToEye;    // of the voxel's centre, and how it changes per pixel along x and y
  // A kernel that the eye plane cuts, q from the eye to its centre in index space: `conic` is q . D of the pixel
  // (0, 0) and its change per pixel along x and y; `depthToEye` is the depth at the eye, its change per world
  // length along the ray, and |q|².
};

// lighting.glsl
struct Light {
  vec3 place;         // from the volume's middle, index space; at infinity the direction towards the light, of which
                      // the largest component is 1
  int atInfinity;
  vec3 color;         // times the intensity
  uvec2 beyond;       // device address of what eye_depths.comp made of it; 0: the light is outside of the volume
  FaceRays fans[6];     // kLookupExact: from the light, as SetupFrame has them from the eye
};

// What splat_setup.comp needs of a frame that is lit.
struct FrameLighting {
  int lightCount;
  int lookup;                    // kLookup... of the lights' transmittances
  int hasAmbient;            // whether there is light in `ambientByDirection`
  vec3 tint;                     // of the extinction, on the way of the light
  float phaseG;
  float surface;                 // how much of the lights is scattered as by surfaces
  int octaves;                   // of scattering
  float octaveScale;             // of each to the one before
  mat3 gradientToWorld;
  vec4 ambientByDirection[kMaximumCells];   // by cell number: radiance from there times its part of the sphere, and that part
};

// The frame, as splat_setup.comp needs it. Index space is relative to the middle of the volume, so that
// 32-bit floats keep their precision far from the origin.
struct SetupFrame {
  mat3 indexToWorld;       // linear part
  mat3 indexToPixel;       // index offset -> (x t, y t, t), orthographic (x, y, t): see PixelRays for x, y and t
  vec3 middle;             // of the volume, index space
  vec3 eyeToMiddle;        // from the ray origin, index space
  vec3 middleInPixels;     // indexToPixel * eyeToMiddle
  vec3 pixelX, pixelY;     // how the ray moves with x and y: its direction, or orthographic its origin; index space
  vec3 ray;                // of pixel (0, 0), index space; orthographic: all rays have its direction
  vec2 imageSize;          // pixels
  int orthographic;
  ivec3 dimensions;
  BlockLevel levels[kMaximumLevels];
  BlockStores stores;
  int levelCount;
  float voxelSize;         // edge of the cube with a voxel's volume, world units
  int lookup;              // kLookup...
  float rayShare;          // of the depth to the eye that is along rays; the rest is the table's. kLookupExact: 1
  uvec2 sourceDepth;         // device address of what eye_depths.comp made; 0: the eye is outside of the volume
  int pathLengthCorrection;  // 0: every lattice step counts as long as any other
  int kernelMean;          // 1: a voxel has the mean of the transmittance over its kernel, along the line of sight
  int gradient;            // 0: the transmittance to the eye is the same all over a footprint
  int code;                // kCode...
  int cells;               // that the table's directions divide the cube's half edge into
  vec3 albedo;
  float emissionUnit;      // radiance per world unit that a stored 1 is
  FaceRays fans[6];          // kLookupExact: from the eye, by fanIndex; orthographic six times the same
  FrameLighting lighting;
};

struct SetupPush {
  uint chunk;
};

// eye_depths.comp
struct EyeDepthsPush {
  BlockLevel voxels;
  BlockStores stores;
  vec3 place;        // of the eye, index space, in the box of the voxels' centres
  int cells;         // that the table's directions divide the cube's half edge into
  int first;         // of the depths, by cell number from here on
};

// splat.vert and splat.frag
struct SplatPush {
  vec2 imageMiddle;        // pixels
  vec3 rayLength2;         // |D|² of the pixel ray in index space at (x, y) from the middle: rayLength2 . (1, x, y)
  vec3 rayLength2Squares;  //   + rayLength2Squares . (x², xy, y²)
  vec3 worldLength2;       // the same in world space
  vec3 worldLength2Squares;
  vec2 viewportOrigin;   // of the enlarged viewport, pixels
  vec2 viewportSize;
};

// resolve.comp
struct ResolvePush {
  vec3 ray, rayX, rayY;                  // index space
  vec3 worldRay, worldRayX, worldRayY;   // the same, world space
  ivec2 size;
  int composite;                         // kComposite...
};

// tile_opacity.comp
struct TilePush {
  ResolvePush rays;
  float hiddenDepth;   // optical depth of a covered pixel, at least
  uvec2 tiles;         // of the image
};

#ifdef __cplusplus
}  // namespace freevoxels::shader
#endif
#endif
