#ifndef FREEVOXELS_SCATTERING_INTERFACE_H
#define FREEVOXELS_SCATTERING_INTERFACE_H
// Structs that C++ and the shaders of scattering share. engine/lighting/scattering_solver.h describes the passes.
//
// A vector has the values of all cells, plane after plane: for each moment of the radiance's direction (its mean, and with a phase function
// the three components of its flux) and for each channel a plane of all cells, x fastest. The vectors of a grid are in one buffer. Shaders
// read them as texels: lavapipe reads buffers lane by lane.
#include "interface.h"

#ifdef __cplusplus
namespace freevoxels::shader {
#endif

FV_CONSTANT int kScatteringThreads = 64;
FV_CONSTANT int kDirectThreads = 64;
FV_CONSTANT int kDotSums = 64 * kScatteringThreads;  // that a scalar product is made of, at equal distances
FV_CONSTANT int kMaxBasis = 12;  // vectors that GMRES keeps before it starts again

// A direction of the sweeps.
struct SweepDirection {
  ivec3 step;        // to the next cell
  float stepLength;  // world units
  vec3 unit;         // of the step in world space
  float weight;      // fraction of the sphere
  vec3 sky;          // radiance with which lines enter the volume
};

// scattering_direct.comp: the rays of a light through the direct cells, as RaySweep::fans()
struct DirectFans {
  FaceRays fans[6];
};
struct ScatteringDirectPush {
  ivec3 cells;
  ivec3 directCells;
  int ratio;           // direct cells along the edge of a cell
  vec3 place;          // of the light, direct cells; at infinity the direction towards it
  vec3 radiance;       // irradiance / 4 pi, for a position at distance 1
  vec3 depthScale;     // factor of optical depths, by channel
  int isFirst;         // whether it is the first light
  mat3 directToWorld;  // linear part
  uvec2 rays;          // device address of the rays' depths
};

// scattering_source.comp
struct ScatteringSourcePush {
  int count;         // cells
  int scattering;    // first plane of the medium's scattering coefficients
  int emission;      // first plane of emission; -1 leaves it out
  int from, direct;  // the vectors whose sum is scattered; -1 for none
};

// scattering_sweep.comp
struct ScatteringSweepPush {
  ivec3 cells;
  int firstDirection;  // of the batch
  int hasSky;
  float flux;  // factor of the flux in the light that is scattered
};

// scattering_collect.comp
struct ScatteringCollectPush {
  int count;                       // cells
  int firstDirection, directions;  // of the batch, whose light is added to the sum in vector `to`, which begins with direction 0
  int isLast;                      // whether it is the last batch: to = ofFrom * from + ofSum * (sum over all directions)
  int from, to;                    // vectors
  float ofFrom, ofSum;
};

// scattering_dots.comp
struct ScatteringDotsPush {
  int values;  // of a vector
  int vector;  // multiplied by the vectors from `first` on
  int first, count;
};

// scattering_combine.comp: to = scale * (from + sum of factors * the vectors from `first` on)
struct ScatteringCombinePush {
  int values;    // of a vector
  int to, from;  // -1: 0
  int first, count;
  float scale;
  float factors[kMaxBasis];
};

// scattering_refine.comp: the first vector of a grid from that of one with cells of twice the edge
struct ScatteringRefinePush {
  ivec3 cells, coarseCells;
  int planes;
};

// scattering_texels.comp
struct ScatteringTexelsPush {
  int count;  // cells
  int channels, moments;
};

#ifdef __cplusplus
static_assert(sizeof(ScatteringDirectPush) <= 128);
}  // namespace freevoxels::shader
#endif
#endif
