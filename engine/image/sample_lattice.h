#pragma once
// The lattice of image samples of which the sums of a gathered frame are made, and the way from these sums to the pixels.

#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine/image/image.h"

namespace freevoxels {

/// Distances between samples are multiples of this part of a pixel, so that their positions are exact in 32 bits.
inline constexpr double kPitchUnits = 1024.0;

/// All positions on the image are relative to its middle, in pixels. A value that is affine in the position is (1, x, y) . value.
struct SampleLattice {
  glm::ivec2 samples{0};
  double pitch = 1.0;      ///< pixels between neighbouring samples
  glm::dvec2 first{0.0};   ///< position of sample (0, 0)
  /// How a ray moves along an index axis of the volume, and how a step along that axis looks on the image.
  struct Axis {
    glm::dvec3 along{0.0};   ///< affine: component of the ray's direction, per world unit of distance from the eye plane
    glm::dvec2 tilt{0.0};    ///< pixels of a step at distance 1 in the image's middle; orthographic: anywhere
    double tiltDepth = 0.0;  ///< change of the distance by a step
    bool operator==(const Axis&) const = default;
  };
  std::array<Axis, 3> axes{};
  int mainAxis = 2;  ///< along which rays march, except for those with less than kMinAlong of their direction along it
  bool orthographic = false;
  bool scalars = false;            ///< whether voxels are classified after interpolation
  bool depth = false;              ///< whether the image has depth
  int raysOfPixel = 0;  ///< with a holdout: along each axis, the samples of a pixel, of which alone it is made, without a stencil; else 0
  glm::dvec2 seenLow{0.0}, seenHigh{0.0};  ///< range of positions in which the volume is visible

  bool operator==(const SampleLattice&) const = default;
};

/// The number of samples of an image's lattice. Odd, so that every second sample is on each border of the lattice.
glm::ivec2 latticeSamples(glm::ivec2 size, double pitch);

/// The least distance between the samples of an image of this size, in pixels: a multiple of 1 / kPitchUnits. With it, images of less than
/// 16 million pixels have no more than 16 million samples and those on the borders of the lattice, and larger images no more than 64 million.
double leastPitch(glm::ivec2 size);

/// With a holdout: the samples of a pixel along each axis, in images of this size. Fails with ErrorKind::Usage if one sample a pixel is
/// more than any image has.
int raysOfHeldOutPixel(glm::ivec2 size);

/// The lattice as one line of text, from which latticeOf makes an equal one.
std::string latticeText(const SampleLattice& lattice);
/// Throws std::invalid_argument if `text` is no lattice.
SampleLattice latticeOf(const std::string& text);

/// The premultiplied light (rgb), alpha (a) and mean distance times alpha of a sample.
struct LatticeSample {
  glm::dvec4 color{0.0};
  double distance = 0.0;
};

/// What gather_stencil.comp and gather_resample.frag compute, in double precision on the host: restores the round footprint of classified
/// voxels, and interpolates the samples and averages them over pixels. `samples` are those of the whole lattice, x fastest.
Image resolveLattice(const SampleLattice& lattice, glm::ivec2 size, std::vector<LatticeSample> samples);

}  // namespace freevoxels
