#include "apps/bench/native_march.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "engine/image/metrics.h"
#include "engine/renderer.h"
#include "engine/scene/camera.h"
#include "engine/validation/quality_scenes.h"
#include "engine/volume/procedural.h"
#include "engine/volume/subject.h"
#include "engine/volume/volume.h"

namespace freevoxels::bench {

namespace {

constexpr int kLanes = 8, kTableSize = 4096, kSlicesBetweenTests = 8;
constexpr float kOpaque = 1.0f / 512.0f;  // transmittance, as GatherSettings::endTransmittance

/// Scalars of all voxels, and the medium by scalar.
struct Field {
  glm::ivec3 size;
  std::vector<float> values;      ///< x fastest
  float low, perScalar;           ///< index into `medium`: (scalar - low) * perScalar
  std::vector<glm::vec4> medium;  ///< extinction times colour and extinction, per world unit

  int stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? size.x : size.x * size.y; }
};

Field fieldOf(const Volume& volume, const Classification& classification) {
  Field field{.size = volume.dimensions,
              .values = denseScalars(volume),
              .low = volume.minimum,
              .perScalar = float(kTableSize - 1) / std::max(volume.maximum - volume.minimum, 1e-20f),
              .medium = {}};
  std::ranges::replace(field.values, kInactiveVoxel, volume.minimum);
  for (int i = 0; i < kTableSize; ++i) {
    const ClassifiedVoxel voxel = classify(classification, field.low + float(i) / field.perScalar);
    field.medium.emplace_back(voxel.extinction * voxel.color, voxel.extinction);
  }
  return field;
}

// Compiled for processors with AVX2 as well, where there are such.
#ifdef __x86_64__
#define FREEVOXELS_FOR_THIS_CPU __attribute__((target_clones("arch=haswell", "default")))
#else
#define FREEVOXELS_FOR_THIS_CPU
#endif

using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Ints = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

/// Rays of one axis and direction in index space. On slice s of the axis they are at first + slope * s on the two sides.
struct Packet {
  Floats firstA, slopeA, firstB, slopeB;
  Floats begin, end;  ///< the slices in the volume's box; none where begin > end
  Floats layer;       ///< world length of a ray in a slice
  Floats red, green, blue, transmittance;
};

/// Marches through the slices from `first` to `last`.
FREEVOXELS_FOR_THIS_CPU void march(const Field& field, int axis, int first, int last, Packet& rays) {
  const int sideA = axis == 0 ? 1 : 0, sideB = axis == 2 ? 1 : 2, step = first <= last ? 1 : -1;
  const int strideA = field.stride(sideA), strideB = field.stride(sideB), strideS = field.stride(axis);
  const Floats zero = Floats{}, mostA = zero + float(field.size[sideA] - 2), mostB = zero + float(field.size[sideB] - 2);
  const Floats lastEntry = zero + float(kTableSize - 1), most = zero + 100.0f, least = zero + 1e-20f;
  const Floats firstA = rays.firstA, slopeA = rays.slopeA, firstB = rays.firstB, slopeB = rays.slopeB;
  Floats red = rays.red, green = rays.green, blue = rays.blue, transmittance = rays.transmittance;
  for (int slice = first, tested = 0; slice != last + step; slice += step, ++tested) {
    const float s = float(slice);
    const Floats a = firstA + slopeA * s, b = firstB + slopeB * s;
    Floats wholeA = __builtin_convertvector(__builtin_convertvector(a, Ints), Floats);
    Floats wholeB = __builtin_convertvector(__builtin_convertvector(b, Ints), Floats);
    wholeA = wholeA < zero ? zero : wholeA > mostA ? mostA : wholeA;
    wholeB = wholeB < zero ? zero : wholeB > mostB ? mostB : wholeB;
    const Floats partA = a - wholeA, partB = b - wholeB;
    const Ints places = __builtin_convertvector(wholeA, Ints) * strideA + __builtin_convertvector(wholeB, Ints) * strideB + slice * strideS;
    Floats corner00 = zero, corner10 = zero, corner01 = zero, corner11 = zero;
    for (int i = 0; i < kLanes; ++i) {
      const float* const value = field.values.data() + places[i];
      corner00[i] = value[0];
      corner10[i] = value[strideA];
      corner01[i] = value[strideB];
      corner11[i] = value[strideA + strideB];
    }
    const Floats low = corner00 + partA * (corner10 - corner00), high = corner01 + partA * (corner11 - corner01);
    Floats entry = (low + partB * (high - low) - field.low) * field.perScalar;
    entry = entry < zero ? zero : entry > lastEntry ? lastEntry : entry;
    const Ints entries = __builtin_convertvector(entry, Ints);
    Floats ownRed = zero, ownGreen = zero, ownBlue = zero, extinction = zero;
    for (int i = 0; i < kLanes; ++i) {
      const glm::vec4& medium = field.medium[std::size_t(entries[i])];
      ownRed[i] = medium.r;
      ownGreen[i] = medium.g;
      ownBlue[i] = medium.b;
      extinction[i] = medium.a;
    }
    const Floats length = (s >= rays.begin) & (s <= rays.end) ? rays.layer : zero;
    Floats depth = length * extinction * 1.44269504f;
    depth = depth > most ? most : depth;
    // 2^-depth is 2^-whole, whose bits are made by hand, times a polynomial of the rest, which is in -1..0.
    const Ints whole = __builtin_convertvector(depth, Ints);
    const Floats part = __builtin_convertvector(whole, Floats) - depth;
    const Floats fraction =
        1.0f + part * (0.69314718f + part * (0.24022651f + part * (0.05550411f + part * (0.00961813f + part * 0.00133336f))));
    const Floats through = fraction * (Floats)((127 - whole) << 23);
    const Floats seen = transmittance * (1.0f - through) / (extinction > least ? extinction : least);
    red += seen * ownRed;
    green += seen * ownGreen;
    blue += seen * ownBlue;
    transmittance *= through;
    if (tested % kSlicesBetweenTests != kSlicesBetweenTests - 1) continue;
    bool ends = true;
    for (int i = 0; i < kLanes; ++i) ends = ends && transmittance[i] < kOpaque;
    if (ends) break;
  }
  rays.red = red;
  rays.green = green;
  rays.blue = blue;
  rays.transmittance = transmittance;
}

struct IndexRay {
  glm::dvec3 origin, direction;  ///< |direction| is 1 along `axis`
  int axis;
  double layer;  ///< world length of `direction`
};

/// The rays among `pixels` that have this axis and sign; others have no slices.
Packet packetOf(std::span<const IndexRay> pixels, const Field& field, int axis, double sign) {
  Packet rays{};
  const int sideA = axis == 0 ? 1 : 0, sideB = axis == 2 ? 1 : 2;
  for (int i = 0; i < kLanes; ++i) {
    rays.begin[i] = 1.0f;
    rays.end[i] = 0.0f;
    rays.transmittance[i] = 0.0f;
    const IndexRay& ray = pixels[std::size_t(i)];
    if (ray.axis != axis || ray.direction[axis] * sign < 0.0) continue;
    rays.transmittance[i] = 1.0f;
    const double slopeA = ray.direction[sideA] * sign, slopeB = ray.direction[sideB] * sign;
    const double firstA = ray.origin[sideA] - slopeA * ray.origin[axis], firstB = ray.origin[sideB] - slopeB * ray.origin[axis];
    double begin = 0.0, end = field.size[axis] - 1;
    if (sign > 0.0) begin = std::max(begin, ray.origin[axis]);
    if (sign < 0.0) end = std::min(end, ray.origin[axis]);
    for (const auto& [first, slope, most] :
         {std::array{firstA, slopeA, double(field.size[sideA] - 1)}, {firstB, slopeB, double(field.size[sideB] - 1)}}) {
      if (std::abs(slope) < 1e-12) {
        if (first < 0.0 || first > most) end = -1.0;
        continue;
      }
      const double one = -first / slope, other = (most - first) / slope;
      begin = std::max(begin, std::min(one, other));
      end = std::min(end, std::max(one, other));
    }
    rays.firstA[i] = float(firstA);
    rays.slopeA[i] = float(slopeA);
    rays.firstB[i] = float(firstB);
    rays.slopeB[i] = float(slopeB);
    rays.begin[i] = float(std::ceil(begin));
    rays.end[i] = float(std::floor(end));
    rays.layer[i] = float(ray.layer);
  }
  return rays;
}

/// Of a perspective camera.
Image marchOnHost(const Field& field, const glm::dmat4& indexToWorld, const Camera& camera, glm::ivec2 size) {
  Image image{.size = size, .pixels = std::vector<glm::vec4>(std::size_t(size.x) * std::size_t(size.y)), .depth = {}};
  const PixelRays all = pixelRays(camera, size, indexToWorld);
  const auto rayOf = [&](int x, int y) {
    const glm::dvec3 direction = all.direction + (x + 0.5) * all.directionX + (y + 0.5) * all.directionY, extent = glm::abs(direction);
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const glm::dvec3 perSlice = direction / extent[axis];
    return IndexRay{.origin = all.origin, .direction = perSlice, .axis = axis, .layer = glm::length(glm::dmat3(indexToWorld) * perSlice)};
  };
  tbb::parallel_for(0, size.y, [&](int y) {
    for (int x = 0; x < size.x; x += kLanes) {
      std::array<IndexRay, kLanes> pixels;
      for (int i = 0; i < kLanes; ++i) pixels[std::size_t(i)] = rayOf(std::min(x + i, size.x - 1), y);
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
          Packet rays = packetOf(pixels, field, axis, sign);
          float begin = 1e9f, end = -1.0f;
          for (int i = 0; i < kLanes; ++i) {
            if (rays.begin[i] > rays.end[i]) continue;
            begin = std::min(begin, rays.begin[i]);
            end = std::max(end, rays.end[i]);
          }
          if (begin > end) continue;
          march(field, axis, int(sign > 0.0 ? begin : end), int(sign > 0.0 ? end : begin), rays);
          for (int i = 0; i < kLanes && x + i < size.x; ++i) {
            if (rays.begin[i] <= rays.end[i])
              image.pixels[std::size_t(x + i) + std::size_t(size.x) * std::size_t(y)] = {rays.red[i], rays.green[i], rays.blue[i],
                                                                                         1.0f - rays.transmittance[i]};
          }
        }
    }
  });
  return image;
}

}  // namespace

std::vector<Result> nativeMarch(const Device& device, std::string_view name, int resolution, int runs) {
  const bool head = name == "head";
  QualityScene scene = makeQualityScene({head ? "head" : "cloud", head ? QualityColor::Bone : QualityColor::Cloud, false}, resolution,
                                        makeProcedural(std::string(name), resolution));
  scene.classification.order = ClassificationOrder::Post;
  const Camera camera = framingCamera(scene.volume, kDefaultAzimuth, kDefaultElevation, 1.0, {});
  const FrameSettings settings{.size = {1024, 1024}};
  Renderer renderer(device, scene.volume, scene.classification, {});
  const Image gathered = renderer.render(camera, settings);  // with what is made once
  const double frame = least(runs, [&] { return millisecondsOf([&] { renderer.render(camera, settings); }); });
  const Field field = fieldOf(scene.volume, scene.classification);
  Image marched;
  const double native =
      least(runs, [&] { return millisecondsOf([&] { marched = marchOnHost(field, scene.volume.indexToWorld, camera, settings.size); }); });
  return {{.name = fmt::format("frame of {} {}^3, unlit, gather", name, resolution), .milliseconds = frame},
          {.name = fmt::format("march of every ray by the host: {:.2f} of the gather, {:.1f} dB from it", native / frame,
                               compareImages(marched, gathered).psnr),
           .milliseconds = native}};
}

}  // namespace freevoxels::bench
