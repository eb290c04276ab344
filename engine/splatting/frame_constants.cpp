// The constants of a frame: the camera's rays in index space, relative to the volume's middle, and how splats
// are drawn.

#include "engine/splatting/frame_constants.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/footprint.h"
#include "engine/volume/packed_light.h"

namespace freevoxels {

namespace {

static_assert(shader::kSplatRadius == float(kFootprintRadius));
static_assert(shader::kLookupBilinear == int(AttenuationLookup::Bilinear));
static_assert(shader::kLookupNearest == int(AttenuationLookup::Nearest));
static_assert(shader::kCompositeAdditive == int(Composite::Additive));
static_assert(shader::kCompositeSorted == int(Composite::Sorted));

/// Image positions of the box's corners, and the range of their distances from the eye plane.
struct ProjectedBox {
  glm::dvec2 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
  double nearest = std::numeric_limits<double>::max(), farthest = std::numeric_limits<double>::lowest();
};

/// The box of the voxels' centres, and `around` voxels more on all sides.
ProjectedBox projectBox(const glm::dmat3& toPixel, const PixelRays& rays, glm::ivec3 dimensions, double around = 0.0) {
  ProjectedBox box;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 voxel = glm::mix(glm::dvec3(-around), glm::dvec3(dimensions - 1) + around, side);
    const glm::dvec3 pixel = toPixel * (voxel - rays.origin);
    const glm::dvec2 position = rays.orthographic ? glm::dvec2(pixel) : glm::dvec2(pixel) / pixel.z;
    box.low = glm::min(box.low, position);
    box.high = glm::max(box.high, position);
    box.nearest = std::min(box.nearest, pixel.z);
    box.farthest = std::max(box.farthest, pixel.z);
  }
  return box;
}

/// |ray + x rayX + y rayY|² = linear . (1, x, y) + squares . (x², xy, y²)
struct LengthSquared {
  LengthSquared(glm::dvec3 ray, glm::dvec3 rayX, glm::dvec3 rayY)
      : linear(glm::dot(ray, ray), 2.0 * glm::dot(ray, rayX), 2.0 * glm::dot(ray, rayY)),
        squares(glm::dot(rayX, rayX), 2.0 * glm::dot(rayX, rayY), glm::dot(rayY, rayY)) {}
  glm::dvec3 linear, squares;
};

/// Upper bound of a splat's extent from its centre, in pixels. For a perspective camera a kernel at distance
/// t reaches at most R |K0 - x K2| / (t - R |K2|) along x (boundsOf in splat_projection.glsl).
double largestHalfExtent(const glm::dmat3& toPixel, const PixelRays& rays, glm::ivec3 dimensions, const DetailRule& detail) {
  const glm::dmat3 rows = glm::transpose(toPixel);
  // A widened footprint reaches farther by at most `widened`. `step` bounds the relative change of |D| from pixel to pixel.
  const double step = std::hypot(glm::length(rays.directionX), glm::length(rays.directionY)) * glm::length(rows[2]);
  const double leastConic = 1.0 / (kFootprintRadius * kFootprintRadius) - step * step;  // of boundsOf's matrix, for |D| = 1
  if (leastConic <= 0.0) return std::numeric_limits<double>::infinity();
  const double widened = step / leastConic + std::sqrt((1.0 + step * step / leastConic) / leastConic);
  if (rays.orthographic)
    return kFootprintRadius * Block{.level = detail.coarsest}.edge() *
               std::max(glm::length(rows[0]), glm::length(rows[1])) +
           widened;
  const ProjectedBox box = projectBox(toPixel, rays, dimensions);
  const double clearance = box.nearest - kFootprintRadius * glm::length(rows[2]);
  if (clearance <= 0.0) return std::numeric_limits<double>::infinity();
  double steepest = 0.0;
  for (int axis = 0; axis < 2; ++axis)
    for (double end : {box.low[axis], box.high[axis]})
      steepest = std::max(steepest, glm::length(rows[axis] - end * rows[2]));
  const double voxels = kFootprintRadius * steepest / clearance;
  // The edge of a drawn block is at most this times its distance.
  const double steepestBlock = detail.coarsest > 0 ? kFootprintRadius * detail.edgePerDistance : 0.0;
  const double blocks = steepestBlock * steepest / (1.0 - steepestBlock * glm::length(rows[2]));
  return std::max(voxels, blocks) + widened;
}

/// Upper bound of the light of any ray through the volume: that of its emission, or without emission of its
/// colours, which are at most 1.
double brightestRay(const DeviceVolume& volume) {
  double longest = 0.0;
  for (const glm::dvec3 signs :
       {glm::dvec3(1, 1, 1), glm::dvec3(-1, 1, 1), glm::dvec3(1, -1, 1), glm::dvec3(1, 1, -1)})
    longest = std::max(longest, glm::length(glm::dmat3(volume.indexToWorld) *
                                            (signs * glm::dvec3(volume.layout.dimensions + 1))));
  return volume.emissionUnit * kBrightest * longest;
}

/// The pixels that splats can reach which are centred in the box and reach no further than `reach` pixels: all of them where the
/// eye plane may cut a splat.
void setCovered(FrameConstants& frame, const ProjectedBox& box, double reach, glm::ivec2 size) {
  frame.coveredExtent = size;
  if (!std::isfinite(reach)) return;
  const glm::dvec2 last = glm::dvec2(size) - 1.0;
  const glm::ivec2 first(glm::clamp(glm::floor(box.low - reach), glm::dvec2(0.0), last));
  frame.coveredFirst = first;
  frame.coveredExtent = glm::ivec2(glm::clamp(glm::ceil(box.high + reach), glm::dvec2(first), last)) - first + 1;
}

shader::SetupFrame setupFrame(const DeviceVolume& volume, const TableSettings& table, const FrameSettings& settings,
                              const PixelRays& rays) {
  const glm::dmat3 toPixel = rays.indexToPixel();
  const glm::dvec3 middle = 0.5 * glm::dvec3(volume.layout.dimensions - 1);
  const glm::dvec3 eyeToMiddle = middle - rays.origin;
  const SplatSettings* const splats = std::get_if<SplatSettings>(&settings.method);
  const bool readsTable = splats != nullptr && !settings.isSorted();
  shader::SetupFrame setup{.indexToWorld = glm::dmat3(volume.indexToWorld),
                           .indexToPixel = toPixel,
                           .middle = middle,
                           .eyeToMiddle = eyeToMiddle,
                           .middleInPixels = toPixel * eyeToMiddle,
                           .pixelX = rays.orthographic ? rays.originX : rays.directionX,
                           .pixelY = rays.orthographic ? rays.originY : rays.directionY,
                           .ray = rays.direction,
                           .imageSize = settings.size,
                           .orthographic = rays.orthographic ? 1 : 0,
                           .dimensions = volume.layout.dimensions,
                           .stores = volume.stores(),
                           .levelCount = int(volume.hierarchy.levels.size()),
                           .voxelSize = float(volume.voxelSize),
                           .lookup = readsTable ? int(splats->attenuation) : shader::kLookupNone,
                           .pathLengthCorrection = table.pathLengthCorrection ? 1 : 0,
                           .kernelMean = readsTable && splats->gradient && splats->composite == Composite::Normalised ? 1 : 0,
                           .gradient = readsTable && splats->gradient ? 1 : 0,
                           .code = int(table.code),
                           .cells = int(table.directions),
                           .albedo = volume.albedo,
                           .emissionUnit = float(volume.emissionUnit)};
  for (int level = 0; level < setup.levelCount; ++level) setup.levels[level] = volume.onDevice(level);
  return setup;
}

}  // namespace

FrameConstants makeFrameConstants(const Device& device, const DeviceVolume& volume,
                                  const TableSettings& table, const Camera& camera,
                                  const FrameSettings& settings) {
  const PixelRays rays = pixelRays(camera, settings.size, volume.indexToWorld);
  const glm::dmat3 toPixel = rays.indexToPixel();
  const glm::dvec2 imageMiddle = 0.5 * glm::dvec2(settings.size);
  const PixelRays fromMiddle = rays.countedFrom(imageMiddle);
  const glm::dmat3 linear(volume.indexToWorld);
  FrameConstants frame{};
  frame.setup = setupFrame(volume, table, settings, fromMiddle);
  frame.detail = detailRule(volume.hierarchy, rays, settings.size, settings.blockPixels());
  frame.cull = cullRule(volume.layout.dimensions, rays, settings);
  frame.brightestRay = brightestRay(volume);
  const double brightest = std::max(frame.brightestRay, 1.0);
  if (settings.gathers()) frame.endTransmittance = double(settings.gather().endTransmittance) / brightest;
  if (frame.cull.hiddenDepth > 0.0) frame.cull.hiddenDepth += std::log(brightest);
  const glm::dvec3 ray = fromMiddle.direction, rayX = fromMiddle.directionX, rayY = fromMiddle.directionY;
  frame.resolve = {.ray = ray,
                   .rayX = rayX,
                   .rayY = rayY,
                   .worldRay = linear * ray,
                   .worldRayX = linear * rayX,
                   .worldRayY = linear * rayY,
                   .size = settings.size,
                   .composite = int(settings.gathers() ? Composite::Normalised : settings.splats().composite)};

  frame.eye = eyeSource(camera, volume.indexToWorld);
  frame.eyeInside = isInside(frame.eye, volume.layout.dimensions);
  frame.lit = settings.lighting.has_value();
  frame.setup.lighting.deltaScale = glm::vec3(1.0f);
  frame.tinted = frame.lit && (settings.lighting->isTinted() || splitPhase(*settings.lighting).forward > 0.0);
  frame.lightsReadTable = frame.lit && settings.lighting->readsTable();

  const double largestPoint = double(device.limits().pointSizeRange[1]);
  const double reach = largestHalfExtent(toPixel, rays, volume.layout.dimensions, frame.detail);
  const ProjectedBox box = projectBox(toPixel, rays, volume.layout.dimensions);
  setCovered(frame, box, reach, settings.size);
  // Blocks end up to an edge beyond the last centre of voxels, and are interpolated for half an edge more.
  frame.farthest = projectBox(toPixel, rays, volume.layout.dimensions, 1.5 * Block{.level = frame.detail.coarsest}.edge()).farthest;
  const double margin = std::ceil(largestPoint / 2.0);
  const double widest = double(std::max(settings.size.x, settings.size.y)) + 2.0 * margin;
  frame.quads = 2.0 * reach > largestPoint || widest > double(device.limits().maxViewportDimensions[0]) ||
                widest > double(device.limits().maxViewportDimensions[1]);
  frame.viewportMargin = frame.quads ? 0.0f : float(margin);
  const LengthSquared index(ray, rayX, rayY), world(linear * ray, linear * rayX, linear * rayY);
  frame.splat = {.imageMiddle = imageMiddle,
                 .rayLength2 = index.linear,
                 .rayLength2Squares = index.squares,
                 .worldLength2 = world.linear,
                 .worldLength2Squares = world.squares,
                 .viewportSize = glm::vec2(settings.size) + 2.0f * frame.viewportMargin};
  return frame;
}

void setScattered(FrameConstants& constants, const Lighting& lighting, const ScatteringSolver& solved) {
  shader::FrameLighting& onDevice = constants.setup.lighting;
  onDevice.scattered = solved.onDevice();
  onDevice.forward = float(splitPhase(lighting).forward);
  onDevice.deltaScale = solved.deltaScale();
  onDevice.tint *= onDevice.deltaScale;
  constants.scatteredRadiance = solved.brightest();
}

}  // namespace freevoxels
