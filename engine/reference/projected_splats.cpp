// Footprints that are exact for any camera and voxel shape.
//
// A pixel's ray D(x, y) passes the voxel p at the distance r in index space. Around the voxel's projected
// centre c, with d = (x, y) - c and q = p - origin, the rays span the plane through Dc = D(c) and the
// derivatives X, Y of D, so that
//   perspective:   r² = |q x D|² / |D|²  = dᵀ G d / |D|²,   G = [U·U U·V; U·V V·V],  U = q x X,  V = q x Y
//   orthographic:  the same with U = Ox x D, V = Oy x D,    Ox, Oy the derivatives of the ray's origin, |D|
//   constant.
// A block's kernel is a voxel's, as much wider as its edge is longer. The kernel's radius R makes it an
// ellipse with the squared semi-axes (in pixels) S = R² |Dc|² G⁻¹, and
//   r²/R² = dᵀ S⁻¹ d · |Dc|²/|D|².
// Where the smaller semi-axis is below R pixels (a voxel smaller than a pixel), S grows to S' = S + (R² - l)
// I, l its smaller eigenvalue, and the footprint's peak shrinks by sqrt(det S / det S'), which keeps its
// energy.
//
// A kernel that a perspective camera's eye plane cuts has no such ellipse. There r² and the distance along
// the ray to its nearest point are taken from q and D directly, and the kernel is integrated from the eye on:
// no voxel appears or goes at once, however near it comes.

#include "engine/reference/projected_splats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/core/error.h"
#include "engine/scene/footprint.h"

namespace freevoxels {

namespace {

constexpr double kR2 = kFootprintRadius * kFootprintRadius;
/// In voxels: at a smaller distance from the eye the direction is undefined.
constexpr double kAtEye = 1e-3;

/// A range of pixels, empty if last < first.
struct PixelBox {
  glm::ivec2 first{0}, last{-1};
};

/// The part of the kernel's line integral that is ahead of a point at -x, in half chords from the chord's
/// middle: the integral of (1 - t²)^(7/2) from -x to 1, over that from -1 to 1.
double partAhead(double x) {
  if (x >= 1.0) return 1.0;
  if (x <= -1.0) return 0.0;
  const double y = 1.0 - x * x, root = std::sqrt(y);
  double integral = std::asin(x);
  double power = root;  // y^(n - 1/2)
  for (int n = 1; n <= 4; ++n, power *= y) integral = (x * power + (2 * n - 1) * integral) / (2 * n);
  return 0.5 + integral / (35.0 / 128.0 * std::numbers::pi);
}

double smallerEigenvalue(const glm::dmat2& symmetric) {
  const double mean = (symmetric[0][0] + symmetric[1][1]) / 2.0;
  const double half = (symmetric[0][0] - symmetric[1][1]) / 2.0;
  const double larger = mean + std::hypot(half, symmetric[0][1]);
  return glm::determinant(symmetric) / larger;
}

/// The pixels whose centres can be inside of the footprint, dᵀ shape d < |D|²: the bounding box of this
/// conic, from its dual, extended by a pixel for rounding. All pixels if the conic is not an ellipse.
PixelBox boundingPixels(const PixelRays& rays, glm::dvec3 central, const ProjectedSplat& splat,
                        glm::ivec2 size) {
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

}  // namespace

SplatProjector::SplatProjector(const Volume& volume, const Camera& camera, glm::ivec2 imageSize)
    : dimensions_(volume.dimensions),
      imageSize_(imageSize),
      rays_(pixelRays(camera, imageSize, volume.indexToWorld)),
      toPixel_(glm::inverse(rays_.orthographic
                                ? glm::dmat3(rays_.originX, rays_.originY, rays_.direction)
                                : glm::dmat3(rays_.directionX, rays_.directionY, rays_.direction))),
      indexToWorld_(volume.indexToWorld) {}

glm::dvec3 SplatProjector::rayDirection(glm::dvec2 pixel) const {
  return rays_.direction + pixel.x * rays_.directionX + pixel.y * rays_.directionY;
}

Block SplatProjector::voxel(std::uint32_t index) const {
  const glm::uvec3 n(dimensions_);
  return {0, glm::ivec3(index % n.x, index / n.x % n.y, index / n.x / n.y)};
}

std::optional<ProjectedSplat> SplatProjector::project(const Block& block, glm::dvec3 place) const {
  const double radius2 = kR2 * block.edge() * block.edge();
  const glm::dvec3 q = place - rays_.origin;
  const glm::dvec3 k = toPixel_ * q;
  ProjectedSplat splat;
  splat.distance = std::max(k.z, 0.0);
  splat.toEye = toEye(box(block).centre());
  splat.pixelX = rays_.orthographic ? rays_.originX : k.z * rays_.directionX;
  splat.pixelY = rays_.orthographic ? rays_.originY : k.z * rays_.directionY;
  const glm::dvec3 rowZ(toPixel_[0][2], toPixel_[1][2], toPixel_[2][2]);
  const double reach =
      kFootprintRadius * block.edge() * glm::length(rowZ);  // extent of the kernel along the viewing axis
  if (k.z <= -reach) return std::nullopt;
  glm::dvec3 u, v;
  if (rays_.orthographic) {
    splat.ahead = partAhead(k.z / reach);
    splat.centre = {k.x, k.y};
    u = glm::cross(rays_.originX, rays_.direction);
    v = glm::cross(rays_.originY, rays_.direction);
  } else {
    if (k.z <= reach) {
      FV_CHECK_EQ(block.level, 0);
      splat.cut = true;
      splat.fromEye = q;
      return splat;
    }
    splat.centre = {k.x / k.z, k.y / k.z};
    u = glm::cross(q, rays_.directionX);
    v = glm::cross(q, rays_.directionY);
  }
  const glm::dvec3 central = rayDirection(splat.centre);
  const double central2 = glm::dot(central, central);
  const glm::dmat2 quadratic(glm::dot(u, u), glm::dot(u, v), glm::dot(u, v), glm::dot(v, v));
  const glm::dmat2 shape = radius2 * central2 * glm::inverse(quadratic);
  const double narrowest = smallerEigenvalue(shape);
  splat.edge2 = narrowest / kR2;
  if (narrowest < kR2) {
    const glm::dmat2 widened = shape + glm::dmat2(kR2 - narrowest);
    splat.widening = std::sqrt(glm::determinant(shape) / glm::determinant(widened));
    splat.shape = central2 * glm::inverse(widened);
  } else {
    splat.shape = quadratic / radius2;
  }
  splat.amplitude = splat.widening * box(block).voxels() / (double(block.edge()) * block.edge());
  return splat;
}

glm::dvec3 SplatProjector::toEye(glm::dvec3 position) const {
  const glm::dvec3 toEye = rays_.origin - position;
  return rays_.orthographic || glm::length(toEye) < kAtEye ? -rayDirection(0.5 * glm::dvec2(imageSize_)) : toEye;
}

double SplatProjector::layerLength(const ProjectedSplat& splat) const {
  const glm::dvec3 size = glm::abs(splat.toEye);
  return glm::length(indexToWorld_ * (splat.toEye / std::max({size.x, size.y, size.z})));
}

double SplatProjector::leaving(const ProjectedSplat& splat, double extinction, int layers) const {
  const double depth = extinction * layers * layerLength(splat);
  return depth > 0.0 ? -std::expm1(-depth) / depth : 1.0;
}

double SplatProjector::opacity(const ProjectedSplat& splat, double extinction, int layers) const {
  return extinction * leaving(splat, extinction, layers);
}

CoveredPixel SplatProjector::cover(const ProjectedSplat& splat, glm::ivec2 pixel) const {
  const glm::dvec2 centre = glm::dvec2(pixel) + 0.5;
  const glm::dvec3 direction = rayDirection(centre);
  const double direction2 = glm::dot(direction, direction);
  const double worldPerIndex = glm::length(indexToWorld_ * direction) / std::sqrt(direction2);
  CoveredPixel covered{.index = std::size_t(pixel.y) * std::size_t(imageSize_.x) + std::size_t(pixel.x),
                       .offset = centre - splat.centre,
                       .omega = 0.0,
                       .ahead = 0.0};
  double inside = 0.0, part = splat.ahead;
  if (splat.cut) {
    const double ahead = glm::dot(splat.fromEye, direction) / std::sqrt(direction2);
    const glm::dvec3 across = glm::cross(splat.fromEye, direction);
    inside = 1.0 - glm::dot(across, across) / (direction2 * kR2);
    covered.ahead = ahead * worldPerIndex;
    if (inside > 0.0) part = partAhead(ahead / (kFootprintRadius * std::sqrt(inside)));
  } else {
    inside = 1.0 - glm::dot(covered.offset, splat.shape * covered.offset) / direction2;
  }
  const double squared = inside * inside;
  if (inside > 0.0)
    covered.omega = kFootprintPeak * splat.amplitude * part * squared * squared * worldPerIndex;
  return covered;
}

void SplatProjector::forEachPixel(const ProjectedSplat& splat,
                                  const std::function<void(const CoveredPixel&)>& visit) const {
  const PixelBox box = splat.cut ? PixelBox{{0, 0}, imageSize_ - 1}
                                 : boundingPixels(rays_, rayDirection(splat.centre), splat, imageSize_);
  for (int y = box.first.y; y <= box.last.y; ++y)
    for (int x = box.first.x; x <= box.last.x; ++x) visit(cover(splat, {x, y}));
}

}  // namespace freevoxels
