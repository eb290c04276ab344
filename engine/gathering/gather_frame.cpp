#include "engine/gathering/gather_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "engine/image/sample_lattice.h"

namespace freevoxels {

namespace {

static_assert(int(IntensityProjection::Maximum) == shader::kMaxIntensity);
static_assert(int(IntensityProjection::Average) == shader::kAverageIntensity);

/// Lattice samples per voxel along an axis of the image, at the reference distance.
constexpr double kSamplesPerVoxel = 2.4;
/// Largest distance between coarse samples of adaptive sampling, in voxels at the reference distance: less than 2, the width of a voxel's
/// tent, so that they meet every voxel.
constexpr double kCoarseVoxels = 1.25;
/// Largest second difference of coarse samples' distances for interpolation, in voxels: its error is an eighth of that on a smooth surface,
/// and up to a half at an edge.
constexpr double kSmoothVoxels = 2.0;

/// Largest part of an image that is filled before a smaller rectangle of pixels is computed: to fill all of it takes as long as to compute
/// a quarter.
constexpr double kMostPixels = 0.75;

std::array<int, 2> sidesOf(int axis) {
  return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
}

/// Edge of a voxel in pixels, seen from straight in front: the smaller one of a slice's two axes; for a perspective camera times the
/// distance from the eye plane. Obliquely it is shorter, but then the next slice shows beside it: with this measure, quality hardly depends
/// on the view.
double pixelsPerVoxel(const PixelRays& rays, const glm::dmat3& linear) {
  const std::array<int, 2> sides = sidesOf(majorAxis(rays.direction));
  return std::min(glm::length(linear[sides[0]]), glm::length(linear[sides[1]])) /
         glm::length(linear * (rays.orthographic ? rays.originX : rays.directionX));
}

/// The distance from the eye plane for which the lattice is made: the middle of the volume; or, if the camera
/// is near to it or inside, most of the distance to its farthest corner, since nearer voxels are sampled more
/// finely anyway.
double referenceDistance(const PixelRays& rays, glm::dvec3 viewAxis, glm::ivec3 dimensions) {
  double middle = 0.0, farthest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 voxel = glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2) * glm::dvec3(dimensions - 1);
    const double distance = glm::dot(viewAxis, voxel - rays.origin);
    middle += distance / 8.0;
    farthest = std::max(farthest, distance);
  }
  return std::max(middle, 0.75 * farthest);
}

shader::GatherAxis gatherAxis(const PixelRays& rays, const glm::dmat3& toPixel, int axis, double middlePlane) {
  const auto affine = [&](const glm::dvec3& at, const glm::dvec3& x, const glm::dvec3& y, int component) {
    return glm::dvec3(at[component], x[component], y[component]);
  };
  shader::GatherAxis result{};
  const glm::dvec3 along = affine(rays.direction, rays.directionX, rays.directionY, axis);
  const glm::dvec3 eye = affine(rays.origin, rays.originX, rays.originY, axis);
  result.along = along;
  result.eye = eye;
  result.middlePlane = float(middlePlane);
  const std::array<int, 2> sides = sidesOf(axis);
  for (std::size_t s = 0; s < 2; ++s) {
    const glm::dvec3 slope = affine(rays.direction, rays.directionX, rays.directionY, sides[s]);
    const glm::dvec3 start = affine(rays.origin, rays.originX, rays.originY, sides[s]);
    result.slope[s] = slope;
    // (start . p) (along . p) + (middlePlane - eye . p) (slope . p), p = (1, x, y). For a perspective camera the
    // origin is constant, for an orthographic one the direction, so that the product is affine.
    const glm::dvec3 toPlane = glm::dvec3(middlePlane, 0.0, 0.0) - eye;
    result.middle[s] = glm::dvec3(
        start.x * along.x + toPlane.x * slope.x,
        start.y * along.x + start.x * along.y + toPlane.y * slope.x + toPlane.x * slope.y,
        start.z * along.x + start.x * along.z + toPlane.z * slope.x + toPlane.x * slope.z);
  }
  result.tilt = glm::dvec2(toPixel[axis]);
  result.tiltDepth = rays.orthographic ? 0.0f : float(toPixel[axis].z);
  return result;
}

using SeenRectangle = std::array<glm::dvec2, 2>;

/// The corners of a rectangle on the image, as (1, x, y).
std::array<glm::dvec3, 4> cornersOf(const SeenRectangle& seen) {
  return {glm::dvec3(1.0, seen[0]), {1.0, seen[1].x, seen[0].y}, {1.0, seen[0].x, seen[1].y}, glm::dvec3(1.0, seen[1])};
}

/// Whether some ray between the positions `seen` reads slices of the level.
bool readsLevel(const shader::GatherFrame& frame, const SeenRectangle& seen, int level) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!someRayHasAxis(frame, axis)) continue;
    for (const glm::dvec3& corner : cornersOf(seen)) {
      const bool ascends = glm::dot(glm::dvec3(frame.axes[axis].along), corner) > 0.0;
      const glm::ivec2 slices = frame.axes[axis].slices[ascends ? 1 : 0][level];
      if (slices.x < slices.y) return true;
    }
  }
  return false;
}

/// The slices of each level that are read by rays whose component along the axis has this sign. A level
/// begins where its blocks are small on the image for all rays between the positions `seen`, or for an orthographic camera by
/// DetailRule::coarsestShare, at a multiple of its blocks' edge, so that every voxel counts once.
void setSlices(shader::GatherAxis& axis, int axisIndex, int sign, const HierarchyLayout& hierarchy,
               const DetailRule& detail, const SeenRectangle& seen, bool orthographic) {
  const int voxels = hierarchy.levels.front().dimensions[axisIndex];
  std::vector<int> begins(std::size_t(detail.coarsest) + 2);  // in voxels along the ray's direction
  double steepest = 0.0;
  for (const glm::dvec3& corner : cornersOf(seen))
    steepest = std::max(steepest, std::abs(glm::dot(glm::dvec3(axis.along), corner)));
  const int first = sign > 0 ? 0 : voxels, end = sign > 0 ? voxels : 0;
  for (int level = 0; level <= detail.coarsest; ++level) {
    const double edge = double(1 << level);
    if (level <= detail.finest) {
      begins[std::size_t(level)] = first;
      continue;
    }
    const double place = orthographic ? first + sign * (1.0 - detail.coarsestShare) * voxels
                                      : double(axis.eye.x) + 0.5 + sign * edge * steepest / std::max(detail.edgePerDistance, 1e-300);
    const double aligned = (sign > 0 ? std::ceil(place / edge) : std::floor(place / edge)) * edge;
    begins[std::size_t(level)] = int(std::clamp(aligned, 0.0, double((voxels + (1 << level) - 1) >> level << level)));
  }
  begins[std::size_t(detail.coarsest) + 1] = end;
  for (int level = 0; level <= detail.coarsest; ++level) {
    const int a = begins[std::size_t(level)], b = begins[std::size_t(level) + 1];
    const int low = std::min(a, b), high = std::max(a, b);
    const int edge = 1 << level;
    const bool none = sign > 0 ? b <= a : b >= a;
    axis.slices[sign > 0 ? 1 : 0][level] = none ? glm::ivec2(0) : glm::ivec2(low / edge, (high + edge - 1) / edge);
  }
}

/// The range of pixel positions, relative to the image's middle, in which blocks of this edge in voxels are visible; the whole image plane
/// if the eye is in or near the volume's planes.
SeenRectangle seenRectangle(const PixelRays& rays, const glm::dmat3& toPixel, glm::ivec3 dimensions, int edge) {
  constexpr double kAll = 1e9;
  // Interpolated slices reach one block beyond the outermost centres.
  const glm::dvec3 begin(-0.5 - 0.5 * edge), end = glm::dvec3((dimensions + edge - 1) / edge * edge) - 0.5 + 0.5 * edge;
  SeenRectangle seen{glm::dvec2(kAll), glm::dvec2(-kAll)};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 pixel = toPixel * (glm::mix(begin, end, side) - rays.origin);
    if (!rays.orthographic && !(pixel.z > 1e-6)) return {glm::dvec2(-kAll), glm::dvec2(kAll)};
    const glm::dvec2 position = rays.orthographic ? glm::dvec2(pixel) : glm::dvec2(pixel) / pixel.z;
    seen = {glm::min(seen[0], position), glm::max(seen[1], position)};
  }
  return {seen[0] - 1.0, seen[1] + 1.0};
}

/// Fills in the rectangles of samples and of pixels outside of which nothing is seen. `seen` is that of the coarsest blocks.
void setSeen(shader::GatherFrame& frame, const SeenRectangle& seen) {
  constexpr double kMargin = 3.0;       // samples: at least one without any light, however `seenLow` is rounded, and one for the stencil
  constexpr double kPixelMargin = 4.0;  // samples: the stencil's reach and the interpolation's
  const double pitch = double(frame.pitch);
  const glm::dvec2 low = (seen[0] - glm::dvec2(frame.firstSample)) / pitch;
  const glm::dvec2 high = (seen[1] - glm::dvec2(frame.firstSample)) / pitch;
  const glm::dvec2 lastSample(frame.samples - 1), lastPixel(frame.size - 1);
  frame.firstSeen = glm::ivec2(glm::clamp(glm::floor(low) - kMargin, glm::dvec2(0.0), lastSample)) & ~1;
  frame.seenExtent =
      ((glm::ivec2(glm::clamp(glm::ceil(high) + kMargin, glm::dvec2(frame.firstSeen), lastSample)) + 1) & ~1) - frame.firstSeen + 1;
  frame.ownCells = {0, (frame.seenExtent.y + 1) / 2};
  const auto pixelAt = [&](glm::dvec2 sample) { return (sample - double(shader::kLatticeMargin)) * pitch; };
  frame.firstPixel = glm::ivec2(glm::clamp(glm::floor(pixelAt(low - kPixelMargin)) - 1.0, glm::dvec2(0.0), lastPixel));
  frame.pixelExtent =
      glm::ivec2(glm::clamp(glm::ceil(pixelAt(high + kPixelMargin)) + 1.0, glm::dvec2(frame.firstPixel), lastPixel)) - frame.firstPixel + 1;
  if (double(frame.pixelExtent.x) * frame.pixelExtent.y <= kMostPixels * double(frame.size.x) * frame.size.y) return;
  frame.firstPixel = glm::ivec2(0);
  frame.pixelExtent = frame.size;
}

/// The smallest rectangle around both.
void extend(glm::ivec2& first, glm::ivec2& extent, glm::ivec2 otherFirst, glm::ivec2 otherExtent) {
  const glm::ivec2 end = glm::max(first + extent, otherFirst + otherExtent);
  first = glm::min(first, otherFirst);
  extent = end - first;
}

}  // namespace

double quartersOf(glm::dvec3 direction) {
  constexpr double kLong = 1.45, kLongest = 1.6;  // voxels
  constexpr double kOblique = 0.87, kDiagonal = 0.97;  // slopes
  const auto part = [](double value, double low, double high) { return std::clamp((value - low) / (high - low), 0.0, 1.0); };
  std::array<double, 3> sizes{std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)};
  std::ranges::sort(sizes, std::greater());
  return std::max(part(glm::length(direction) / sizes[0], kLong, kLongest), part(sizes[1] / sizes[0], kOblique, kDiagonal));
}

/// Tests a grid of rays, with a margin for the rays in between.
bool someRayHasAxis(const shader::GatherFrame& frame, int axis) {
  if (axis == frame.mainAxis) return true;
  constexpr int kGrid = 64;
  constexpr float kMargin = 1.05f;
  const glm::vec2 half = 0.5f * glm::vec2(frame.size) + 2.0f * frame.pitch;
  const glm::vec2 low = glm::max(frame.seenLow, -half), high = glm::min(frame.seenHigh, half);
  if (low.x > high.x || low.y > high.y) return false;
  for (int j = 0; j <= kGrid; ++j) {
    for (int i = 0; i <= kGrid; ++i) {
      const glm::vec3 position(1.0f, glm::mix(low, high, glm::vec2(float(i), float(j)) / float(kGrid)));
      glm::vec3 size;
      for (int a = 0; a < 3; ++a) size[a] = std::abs(glm::dot(frame.axes[a].along, position));
      const float largest = std::max({size.x, size.y, size.z});
      if (size[frame.mainAxis] <= kMargin * shader::kMinAlong * largest && kMargin * size[axis] >= largest) return true;
    }
  }
  return false;
}

std::optional<SampleRectangle> samplesThatSee(const DeviceVolume& volume, const Camera& camera, const shader::GatherFrame& frame,
                                              glm::ivec3 begin, glm::ivec3 end) {
  constexpr double kMargin = 2.0;  // samples
  const PixelRays rays = pixelRays(camera, frame.size, volume.indexToWorld).countedFrom(0.5 * glm::dvec2(frame.size));
  const bool orthographic = frame.orthographic != 0;
  const glm::dmat3 toPixel = rays.indexToPixel();
  glm::dvec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  int behind = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 place = glm::mix(glm::dvec3(begin) - 1.0, glm::dvec3(end), glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2));
    const glm::dvec3 pixel = toPixel * (place - rays.origin);
    behind += !orthographic && !(pixel.z > 1e-6) ? 1 : 0;
    const glm::dvec2 position = (glm::dvec2(pixel) / (orthographic ? 1.0 : std::max(pixel.z, 1e-6)) - glm::dvec2(frame.firstSample)) / double(frame.pitch);
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  if (behind == 8) return {};
  if (behind > 0) return SampleRectangle{.first = frame.firstSeen, .extent = frame.seenExtent};
  const glm::dvec2 begun(frame.firstSeen), last(frame.firstSeen + frame.seenExtent - 1);
  if (glm::any(glm::lessThan(high + kMargin, begun)) || glm::any(glm::greaterThan(low - kMargin, last))) return {};
  const glm::ivec2 first(glm::clamp(glm::floor(low) - kMargin, begun, last));
  return SampleRectangle{.first = first, .extent = glm::ivec2(glm::clamp(glm::ceil(high) + kMargin, glm::dvec2(first), last)) - first + 1};
}

void shareLattice(std::span<shader::GatherFrame> frames, const FrameSettings& settings) {
  const shader::GatherFrame& finest = *std::ranges::min_element(frames, {}, &shader::GatherFrame::pitch);
  shader::GatherFrame common = finest;
  common.sampleTolerance = std::ranges::min(frames, {}, &shader::GatherFrame::sampleTolerance).sampleTolerance;
  common.distanceTolerance = std::ranges::min(frames, {}, &shader::GatherFrame::distanceTolerance).distanceTolerance;
  common.endTransmittance = std::ranges::min(frames, {}, &shader::GatherFrame::endTransmittance).endTransmittance;
  const double pitch = double(common.pitch);
  // The rectangle that each frame sees is in samples of its own lattice.
  for (const shader::GatherFrame& frame : frames) {
    const double scale = double(frame.pitch) / pitch;
    // Position on the image of a sample of the frame, in samples of the common lattice.
    const auto place = [&](glm::ivec2 sample) {
      return (glm::dvec2(frame.firstSample) + double(frame.pitch) * glm::dvec2(sample) - glm::dvec2(common.firstSample)) / pitch;
    };
    const glm::dvec2 last(common.samples - 1);
    const glm::ivec2 first = glm::ivec2(glm::clamp(glm::floor(place(frame.firstSeen) - scale), glm::dvec2(0.0), last)) & ~1;
    const glm::ivec2 end =
        glm::ivec2(glm::clamp(glm::ceil(place(frame.firstSeen + frame.seenExtent - 1) + scale), glm::dvec2(first), last));
    extend(common.firstSeen, common.seenExtent, first, ((end + 1) & ~1) - first + 1);
    extend(common.firstPixel, common.pixelExtent, frame.firstPixel, frame.pixelExtent);
  }
  common.ownCells = {0, (common.seenExtent.y + 1) / 2};
  if (double(common.pixelExtent.x) * common.pixelExtent.y > kMostPixels * double(settings.size.x) * settings.size.y) {
    common.firstPixel = glm::ivec2(0);
    common.pixelExtent = settings.size;
  }
  for (shader::GatherFrame& frame : frames) {
    frame.pitch = common.pitch;
    frame.samples = common.samples;
    frame.firstSample = common.firstSample;
    frame.firstSeen = common.firstSeen;
    frame.seenExtent = common.seenExtent;
    frame.ownCells = common.ownCells;
    frame.firstPixel = common.firstPixel;
    frame.pixelExtent = common.pixelExtent;
    frame.sampleTolerance = common.sampleTolerance;
    frame.distanceTolerance = common.distanceTolerance;
    frame.endTransmittance = common.endTransmittance;
  }
}

shader::GatherFrame makeGatherFrame(const DeviceVolume& volume, const Camera& camera, const FrameSettings& settings,
                                    const DetailRule& detail, double endTransmittance) {
  const PixelRays rays = pixelRays(camera, settings.size, volume.indexToWorld).countedFrom(0.5 * glm::dvec2(settings.size));
  const bool orthographic = rays.orthographic;
  const glm::dmat3 toPixel = rays.indexToPixel();
  const glm::dmat3 linear(volume.indexToWorld);
  const glm::ivec3 dimensions = volume.layout.dimensions;
  const double voxel = pixelsPerVoxel(rays, linear);
  const glm::dvec3 viewAxis = glm::transpose(toPixel)[2];
  const double distance = orthographic ? 1.0 : referenceDistance(rays, viewAxis, dimensions);
  const glm::dvec2 size(settings.size);
  const int raysOfPixel = settings.holdout ? raysOfHeldOutPixel(settings.size) : 0;
  // At least a few samples, however near the volume is.
  const double least = std::max(leastPitch(settings.size), 1.0 / settings.mostSamplesAcrossPixel());
  const double wanted = std::clamp(voxel / (kSamplesPerVoxel * std::max(distance, 1e-300)), least, std::max(size.x, size.y));
  const double pitch = raysOfPixel > 0 ? 1.0 / raysOfPixel : std::round(wanted * kPitchUnits) / kPitchUnits;
  // Coarse samples, two pitches apart, would miss single voxels that are much smaller, and edges of a holdout if not each pixel has one.
  const bool adapts = 2.0 * pitch * distance <= kCoarseVoxels * voxel && raysOfPixel != 1;

  // Seen obliquely, the blocks at a slice's near end become small long after those of its far end: a level may come in slice by
  // slice only after the rule calls all of its blocks small.
  DetailRule slabs = detail;
  if (!orthographic || detail.coarsestShare < 1.0) slabs.finest = std::max(detail.finest - 1, 0);

  shader::GatherFrame frame{.finest = slabs.finest,
                            .coarsest = detail.coarsest,
                            .size = settings.size,
                            .pitch = float(pitch),
                            .sampleTolerance = adapts ? settings.sampleTolerance() : 0.0f,
                            .distanceTolerance = float(kSmoothVoxels * volume.voxelSize),
                            .endTransmittance = float(endTransmittance),
                            .orthographic = orthographic ? 1 : 0,
                            .mainAxis = majorAxis(rays.direction),
                            .projection = int(settings.gather().projection),
                            .raysOfPixel = raysOfPixel};
  if (raysOfPixel == 0) frame.quarters = float(quartersOf(rays.direction));
  if (const std::optional<RayClip>& clip = settings.clip) {
    frame.clips = 1;
    frame.clipLow = clip->low;
    frame.clipHigh = clip->high;
    frame.clipNormal = clip->normal;
    frame.clipDistance = clip->normal == glm::dvec3(0.0) ? 1.0f : float(clip->distance);  // all positions are behind no plane
  }
  const SeenRectangle seen = seenRectangle(rays, toPixel, dimensions, 1);
  frame.seenLow = seen[0];
  frame.seenHigh = seen[1];
  frame.samples = latticeSamples(settings.size, double(frame.pitch));
  // The first pixel's middle, or the first of its own samples.
  const float inPixel = raysOfPixel > 0 ? 0.5f * frame.pitch : 0.5f;
  frame.firstSample = -0.5f * glm::vec2(settings.size) + inPixel - float(shader::kLatticeMargin) * frame.pitch;
  setSeen(frame, seenRectangle(rays, toPixel, dimensions, 1 << detail.coarsest));
  frame.worldRay[0] = linear * rays.direction;
  frame.worldRay[1] = linear * rays.directionX;
  frame.worldRay[2] = linear * rays.directionY;
  const glm::dvec2 half = 0.5 * glm::dvec2(settings.size) + 2.0 * double(frame.pitch);
  const SeenRectangle seenInImage{glm::clamp(seen[0], -half, half), glm::clamp(seen[1], -half, half)};
  for (int axis = 0; axis < 3; ++axis) {
    frame.axes[axis] = gatherAxis(rays, toPixel, axis, 0.5 * (dimensions[axis] - 1));
    for (const int sign : {-1, 1})
      setSlices(frame.axes[axis], axis, sign, volume.hierarchy, slabs, seenInImage, orthographic);
  }
  while (frame.finest < frame.coarsest && !readsLevel(frame, seenInImage, frame.finest)) ++frame.finest;
  while (frame.finest < frame.coarsest && !readsLevel(frame, seenInImage, frame.coarsest)) --frame.coarsest;
  return frame;
}

}  // namespace freevoxels
