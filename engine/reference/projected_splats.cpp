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

#include "engine/reference/projected_splats.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/splatting/footprint.h"

namespace freevoxels {

namespace {

constexpr double kR2 = kFootprintRadius * kFootprintRadius;

/// First and last pixel of a range; empty where last < first.
struct PixelBox {
  glm::ivec2 first{0}, last{-1};
};

double smallerEigenvalue(const glm::dmat2& symmetric) {
  const double mean = (symmetric[0][0] + symmetric[1][1]) / 2.0;
  const double half = (symmetric[0][0] - symmetric[1][1]) / 2.0;
  const double larger = mean + std::hypot(half, symmetric[0][1]);
  return glm::determinant(symmetric) / larger;
}

/// The pixels whose centres can be inside of the footprint, dᵀ shape d < |D|²: the box around that conic,
/// from its dual, one pixel larger against rounding. Every pixel where the conic is no ellipse.
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
  splat.distance = k.z;
  splat.toEye = toEye(box(block).centre());
  splat.pixelX = rays_.orthographic ? rays_.originX : k.z * rays_.directionX;
  splat.pixelY = rays_.orthographic ? rays_.originY : k.z * rays_.directionY;
  if (!(k.z > 0.0)) return std::nullopt;
  glm::dvec3 u, v;
  if (rays_.orthographic) {
    splat.centre = {k.x, k.y};
    u = glm::cross(rays_.originX, rays_.direction);
    v = glm::cross(rays_.originY, rays_.direction);
  } else {
    const glm::dvec3 rowZ(toPixel_[0][2], toPixel_[1][2], toPixel_[2][2]);
    if (!(k.z * k.z - radius2 * glm::dot(rowZ, rowZ) > 0.0)) return std::nullopt;
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
  return rays_.orthographic ? -rays_.direction : rays_.origin - position;
}

double SplatProjector::layerLength(const ProjectedSplat& splat) const {
  const glm::dvec3 size = glm::abs(splat.toEye);
  return glm::length(indexToWorld_ * (splat.toEye / std::max({size.x, size.y, size.z})));
}

double SplatProjector::opacity(const ProjectedSplat& splat, double extinction, int layers) const {
  const double length = layers * layerLength(splat);
  return -std::expm1(-extinction * length) / length;
}

double SplatProjector::footprint(const ProjectedSplat& splat, glm::dvec2 pixel) const {
  const glm::dvec3 direction = rayDirection(pixel);
  const double direction2 = glm::dot(direction, direction);
  const glm::dvec2 d = pixel - splat.centre;
  const double inside = 1.0 - glm::dot(d, splat.shape * d) / direction2;
  if (!(inside > 0.0)) return 0.0;
  const double worldPerIndex = glm::length(indexToWorld_ * direction) / std::sqrt(direction2);
  const double squared = inside * inside;
  return kFootprintPeak * splat.amplitude * squared * squared * worldPerIndex;
}

void SplatProjector::forEachPixel(const ProjectedSplat& splat,
                                  const std::function<void(std::size_t, glm::dvec2, double)>& visit) const {
  const PixelBox box = boundingPixels(rays_, rayDirection(splat.centre), splat, imageSize_);
  for (int y = box.first.y; y <= box.last.y; ++y)
    for (int x = box.first.x; x <= box.last.x; ++x) {
      const glm::dvec2 pixel(x + 0.5, y + 0.5);
      visit(std::size_t(y) * std::size_t(imageSize_.x) + std::size_t(x), pixel - splat.centre,
            footprint(splat, pixel));
    }
}

}  // namespace freevoxels
