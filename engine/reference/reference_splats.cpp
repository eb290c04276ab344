// The picture as a sum of splats: Subr et al. 2007, Section 4.1, Eq. 10, with footprints that are exact for
// any camera and voxel shape, and the normalised resolve of README.md.
//
// A pixel's ray D(x, y) passes the voxel p at the distance r in index space. Around the voxel's projected
// centre c, with d = (x, y) - c and q = p - origin, the rays span the plane through Dc = D(c) and the
// derivatives X, Y of D, so that
//   perspective:   r² = |q x D|² / |D|²  = dᵀ G d / |D|²,   G = [U·U U·V; U·V V·V],  U = q x X,  V = q x Y
//   orthographic:  the same with U = Ox x D, V = Oy x D,    Ox, Oy the derivatives of the ray's origin, |D|
//   constant.
// The kernel's radius R makes it an ellipse with the squared semi-axes (in pixels) S = R² |Dc|² G⁻¹, and
//   r²/R² = dᵀ S⁻¹ d · |Dc|²/|D|².
// Where the smaller semi-axis is below R pixels (a voxel smaller than a pixel), S grows to S' = S + (R² - l)
// I, l its smaller eigenvalue, and the footprint's peak shrinks by sqrt(det S / det S'), which keeps its
// energy.

#include "engine/reference/reference_splats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/attenuation/directions.h"
#include "engine/core/error.h"
#include "engine/splatting/footprint.h"

namespace freevoxels {

namespace {

constexpr double kR2 = kFootprintRadius * kFootprintRadius;

/// First and last pixel of a range; empty where last < first.
struct PixelBox {
  glm::ivec2 first{0}, last{-1};
};

/// One voxel as seen by the camera.
struct Splat {
  glm::dvec2 centre{0.0};  ///< pixels
  double distance = 0.0;   ///< of the voxel's centre along the viewing axis, world units
  glm::dmat2 shape{1.0};   ///< S'⁻¹ · |Dc|²: dᵀ shape d / |D|² is r²/R², or its widened like
  double amplitude = 1.0;  ///< sqrt(det S / det S')
};

glm::dvec3 rayDirection(const PixelRays& rays, glm::dvec2 pixel) {
  return rays.direction + pixel.x * rays.directionX + pixel.y * rays.directionY;
}

double smallerEigenvalue(const glm::dmat2& symmetric) {
  const double mean = (symmetric[0][0] + symmetric[1][1]) / 2.0;
  const double half = (symmetric[0][0] - symmetric[1][1]) / 2.0;
  const double larger = mean + std::hypot(half, symmetric[0][1]);
  return glm::determinant(symmetric) / larger;
}

/// Empty where the voxel is not drawn: its centre is behind the eye plane (k_z <= 0), or a perspective
/// camera's eye plane cuts its kernel (k_z² <= R² (K Kᵀ)_zz).
std::optional<Splat> project(const PixelRays& rays, glm::dvec3 voxel) {
  const glm::dmat3 basis = rays.orthographic ? glm::dmat3(rays.originX, rays.originY, rays.direction)
                                             : glm::dmat3(rays.directionX, rays.directionY, rays.direction);
  const glm::dmat3 inverse = glm::inverse(basis);
  const glm::dvec3 q = voxel - rays.origin;
  const glm::dvec3 k = inverse * q;
  Splat splat;
  splat.distance = k.z;
  if (!(k.z > 0.0)) return std::nullopt;
  glm::dvec3 u, v;
  if (rays.orthographic) {
    splat.centre = {k.x, k.y};
    u = glm::cross(rays.originX, rays.direction);
    v = glm::cross(rays.originY, rays.direction);
  } else {
    const glm::dvec3 rowZ(inverse[0][2], inverse[1][2], inverse[2][2]);
    if (!(k.z * k.z - kR2 * glm::dot(rowZ, rowZ) > 0.0)) return std::nullopt;
    splat.centre = {k.x / k.z, k.y / k.z};
    u = glm::cross(q, rays.directionX);
    v = glm::cross(q, rays.directionY);
  }
  const glm::dvec3 central = rayDirection(rays, splat.centre);
  const double central2 = glm::dot(central, central);
  const glm::dmat2 quadratic(glm::dot(u, u), glm::dot(u, v), glm::dot(u, v), glm::dot(v, v));
  const glm::dmat2 shape = kR2 * central2 * glm::inverse(quadratic);
  const double narrowest = smallerEigenvalue(shape);
  if (narrowest < kR2) {
    const glm::dmat2 widened = shape + glm::dmat2(kR2 - narrowest);
    splat.amplitude = std::sqrt(glm::determinant(shape) / glm::determinant(widened));
    splat.shape = central2 * glm::inverse(widened);
  } else {
    splat.shape = quadratic / kR2;
  }
  return splat;
}

/// The pixels whose centres can be inside of the footprint, dᵀ shape d < |D|²: the box around that conic,
/// from its dual, one pixel larger against rounding. Every pixel where the conic is no ellipse.
PixelBox boundingPixels(const PixelRays& rays, const Splat& splat, glm::ivec2 size) {
  const glm::dvec3 central = rayDirection(rays, splat.centre);
  const std::array<glm::dvec3, 3> columns = {rays.directionX, rays.directionY, central};
  glm::dmat3 conic(0.0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      conic[i][j] = -glm::dot(columns[std::size_t(i)], columns[std::size_t(j)]);
      if (i < 2 && j < 2) conic[i][j] += splat.shape[i][j];
    }
  const glm::dmat2 leading(conic);
  const double determinant = glm::determinant(leading);
  if (!(determinant > 0.0) || !(leading[0][0] > 0.0)) return {{0, 0}, size - 1};
  const glm::dmat3 dual = glm::inverse(conic);  // up to a factor that cancels
  PixelBox box;
  for (int axis = 0; axis < 2; ++axis) {
    const double middle = dual[2][axis] / dual[2][2];
    const double extent = std::sqrt(std::max(0.0, middle * middle - dual[axis][axis] / dual[2][2]));
    const double low = splat.centre[axis] + middle - extent, high = splat.centre[axis] + middle + extent;
    box.first[axis] = int(std::clamp(std::floor(low) - 1.0, 0.0, double(size[axis])));
    box.last[axis] = int(std::clamp(std::ceil(high) + 1.0, -1.0, double(size[axis] - 1)));
  }
  return box;
}

class SplatSummer {
 public:
  SplatSummer(const Volume& volume, const Classification& classification,
              const std::vector<std::vector<std::uint8_t>>& table, AttenuationCode code, const Camera& camera,
              const FrameSettings& settings)
      : volume_(volume),
        classification_(classification),
        table_(table),
        code_(code),
        directions_(directionSetOf(table.size())),
        settings_(settings),
        rays_(pixelRays(camera, settings.size, volume.indexToWorld)),
        indexToWorld_(volume.indexToWorld),
        sums_(std::size_t(settings.size.x) * std::size_t(settings.size.y)) {}

  void add(std::uint32_t voxel);
  std::vector<SplatSums> take() { return std::move(sums_); }

 private:
  /// A(v, to eye).
  double transmittance(std::uint32_t voxel, glm::dvec3 toEye) const {
    const auto decode = [&](int direction) {
      return decodeTransmittance(code_, table_[std::size_t(direction)][voxel]);
    };
    if (settings_.attenuation == AttenuationLookup::Nearest)
      return decode(nearestDirection(directions_, toEye));
    const DirectionBlend blend = bilinearDirections(directions_, toEye);
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) sum += blend.weights[i] * decode(blend.directions[i]);
    return sum;
  }

  /// World length of one lattice layer in this direction.
  double layerLength(glm::dvec3 toEye) const {
    const double largest = std::max({std::abs(toEye.x), std::abs(toEye.y), std::abs(toEye.z)});
    return glm::length(indexToWorld_ * (toEye / largest));
  }

  /// The line integral of the kernel along the pixel's ray, in world length. 0 outside of the footprint.
  double footprint(const Splat& splat, glm::dvec2 pixel) const {
    const glm::dvec3 direction = rayDirection(rays_, pixel);
    const double direction2 = glm::dot(direction, direction);
    const glm::dvec2 d = pixel - splat.centre;
    const double inside = 1.0 - glm::dot(d, splat.shape * d) / direction2;
    if (!(inside > 0.0)) return 0.0;
    const double worldPerIndex = glm::length(indexToWorld_ * direction) / std::sqrt(direction2);
    return kFootprintPeak * splat.amplitude * std::pow(inside, 4.0) * worldPerIndex;
  }

  const Volume& volume_;
  const Classification& classification_;
  const std::vector<std::vector<std::uint8_t>>& table_;
  const AttenuationCode code_;
  const DirectionSet directions_;
  const FrameSettings& settings_;
  const PixelRays rays_;
  const glm::dmat3 indexToWorld_;
  std::vector<SplatSums> sums_;
};

void SplatSummer::add(std::uint32_t voxel) {
  const glm::uvec3 n(volume_.dimensions);
  const glm::dvec3 position(voxel % n.x, voxel / n.x % n.y, voxel / n.x / n.y);
  const std::optional<Splat> splat = project(rays_, position);
  if (!splat) return;
  const glm::dvec3 toEye = rays_.orthographic ? -rays_.direction : rays_.origin - position;
  const ClassifiedVoxel material = classify(classification_, volume_.values[voxel]);
  const double layer = layerLength(toEye);
  const double emitted = transmittance(voxel, toEye) * -std::expm1(-material.extinction * layer) / layer;
  const PixelBox box = boundingPixels(rays_, *splat, settings_.size);
  for (int y = box.first.y; y <= box.last.y; ++y)
    for (int x = box.first.x; x <= box.last.x; ++x) {
      const double omega = footprint(*splat, {x + 0.5, y + 0.5});
      SplatSums& sums = sums_[std::size_t(y) * std::size_t(settings_.size.x) + std::size_t(x)];
      const double energy = emitted * omega;
      sums.color += energy * material.color;
      sums.energy += energy;
      sums.depth += material.extinction * omega;
      sums.distance += energy * splat->distance;
    }
}

}  // namespace

std::vector<SplatSums> referenceSplatSums(const Volume& volume, const Classification& classification,
                                          const std::vector<std::vector<std::uint8_t>>& table,
                                          AttenuationCode code, const Camera& camera,
                                          const FrameSettings& settings,
                                          std::span<const std::uint32_t> voxels) {
  SplatSummer summer(volume, classification, table, code, camera, settings);
  for (const std::uint32_t voxel : voxels) {
    FV_CHECK_LT(voxel, volume.voxelCount());
    summer.add(voxel);
  }
  return summer.take();
}

std::vector<std::uint32_t> referenceVisibleVoxels(const std::vector<double>& extinction) {
  std::vector<std::uint32_t> voxels;
  for (std::size_t i = 0; i < extinction.size(); ++i)
    if (extinction[i] > 0.0) voxels.push_back(std::uint32_t(i));
  return voxels;
}

Image referenceResolve(const std::vector<SplatSums>& sums, const FrameSettings& settings) {
  FV_CHECK_EQ(sums.size(), std::size_t(settings.size.x) * std::size_t(settings.size.y));
  Image image;
  image.size = settings.size;
  for (const SplatSums& sum : sums) {
    const double opacity = -std::expm1(-sum.depth);
    const bool normalised = settings.composite == Composite::Normalised;
    const double factor = normalised && sum.energy > 0.0 ? opacity / sum.energy : 1.0;
    image.pixels.emplace_back(sum.color * factor, normalised ? opacity : sum.energy);
    if (settings.depth)
      image.depth.push_back(sum.energy > 0.0 ? float(sum.distance / sum.energy)
                                             : std::numeric_limits<float>::infinity());
  }
  return image;
}

}  // namespace freevoxels
