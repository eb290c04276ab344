#include "apps/bench/native_march.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
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
  std::vector<float> values;                 ///< x fastest
  float low, perScalar;                      ///< index into the tables: (scalar - low) * perScalar
  std::array<std::vector<float>, 3> colors;  ///< extinction times colour
  std::vector<float> extinction;             ///< per world unit

  int stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? size.x : size.x * size.y; }
};

Field fieldOf(const Volume& volume, const Classification& classification) {
  Field field{.size = volume.dimensions,
              .values = denseScalars(volume),
              .low = volume.minimum,
              .perScalar = float(kTableSize - 1) / std::max(volume.maximum - volume.minimum, 1e-20f),
              .colors = {},
              .extinction = {}};
  std::ranges::replace(field.values, kInactiveVoxel, volume.minimum);
  for (int i = 0; i < kTableSize; ++i) {
    const ClassifiedVoxel voxel = classify(classification, field.low + float(i) / field.perScalar);
    field.extinction.push_back(float(voxel.extinction));
    for (int c = 0; c < 3; ++c) field.colors[std::size_t(c)].push_back(float(voxel.extinction * voxel.color[c]));
  }
  return field;
}

/// Rays of one axis and direction in index space. On slice s of the axis they are at first + slope * s on the two sides.
struct Packet {
  std::array<float, kLanes> firstA, slopeA, firstB, slopeB;
  std::array<float, kLanes> begin, end;  ///< the slices in the volume's box; none where begin > end
  std::array<float, kLanes> layer;       ///< world length of a ray in a slice
  std::array<float, kLanes> red, green, blue, transmittance;
};

/// Marches through the slices from `first` to `last`. Extinction is positive, so that exp(-x) is 2^whole times a polynomial.
__attribute__((target_clones("avx2,fma", "default"))) void march(const Field& field, int axis, int first, int last, Packet& rays) {
  const int sideA = axis == 0 ? 1 : 0, sideB = axis == 2 ? 1 : 2, step = first <= last ? 1 : -1;
  const int strideA = field.stride(sideA), strideB = field.stride(sideB), strideS = field.stride(axis);
  const float mostA = float(field.size[sideA] - 2), mostB = float(field.size[sideB] - 2);
  const float* const values = field.values.data();
  const float *const reds = field.colors[0].data(), *const greens = field.colors[1].data(), *const blues = field.colors[2].data();
  const float* const extinctions = field.extinction.data();
  for (int slice = first, tested = 0; slice != last + step; slice += step, ++tested) {
    const float s = float(slice);
    for (int i = 0; i < kLanes; ++i) {
      const float a = rays.firstA[i] + rays.slopeA[i] * s, b = rays.firstB[i] + rays.slopeB[i] * s;
      const float wholeA = std::min(std::max(float(int(a)), 0.0f), mostA), wholeB = std::min(std::max(float(int(b)), 0.0f), mostB);
      const float partA = a - wholeA, partB = b - wholeB;
      const int place = int(wholeA) * strideA + int(wholeB) * strideB + slice * strideS;
      const float low = values[place] + partA * (values[place + strideA] - values[place]);
      const float high = values[place + strideB] + partA * (values[place + strideA + strideB] - values[place + strideB]);
      const float scalar = low + partB * (high - low);
      const int entry = int(std::min(std::max((scalar - field.low) * field.perScalar, 0.0f), float(kTableSize - 1)));
      const float length = s >= rays.begin[i] && s <= rays.end[i] ? rays.layer[i] : 0.0f;
      const float extinction = extinctions[entry], depth = std::min(length * extinction * 1.44269504f, 100.0f);
      const float whole = float(int(depth)), part = whole - depth;  // 2^-depth = 2^-whole * 2^part, part in -1..0
      const float fraction =
          1.0f + part * (0.69314718f + part * (0.24022651f + part * (0.05550411f + part * (0.00961813f + part * 0.00133336f))));
      const float through = fraction * std::bit_cast<float>((127 - int(whole)) << 23);
      const float seen = rays.transmittance[i] * (1.0f - through) / std::max(extinction, 1e-20f);
      rays.red[i] += seen * reds[entry];
      rays.green[i] += seen * greens[entry];
      rays.blue[i] += seen * blues[entry];
      rays.transmittance[i] *= through;
    }
    if (tested % kSlicesBetweenTests != kSlicesBetweenTests - 1) continue;
    float most = 0.0f;
    for (int i = 0; i < kLanes; ++i) most = std::max(most, rays.transmittance[i]);
    if (most < kOpaque) return;
  }
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
  for (std::size_t i = 0; i < kLanes; ++i) {
    rays.begin[i] = 1.0f;
    rays.end[i] = 0.0f;
    rays.transmittance[i] = 0.0f;
    const IndexRay& ray = pixels[i];
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
          for (std::size_t i = 0; i < kLanes; ++i) {
            if (rays.begin[i] > rays.end[i]) continue;
            begin = std::min(begin, rays.begin[i]);
            end = std::max(end, rays.end[i]);
          }
          if (begin > end) continue;
          march(field, axis, int(sign > 0.0 ? begin : end), int(sign > 0.0 ? end : begin), rays);
          for (int i = 0; i < kLanes && x + i < size.x; ++i) {
            const auto lane = std::size_t(i);
            if (rays.begin[lane] <= rays.end[lane])
              image.pixels[std::size_t(x + i) + std::size_t(size.x) * std::size_t(y)] = {rays.red[lane], rays.green[lane], rays.blue[lane],
                                                                                         1.0f - rays.transmittance[lane]};
          }
        }
    }
  });
  return image;
}

}  // namespace

std::vector<Result> nativeMarch(const Device& device, std::string_view name, int resolution, int runs) {
  const bool head = name == "head";
  const QualityScene scene = makeQualityScene({head ? "head" : "cloud", head ? QualityColor::Bone : QualityColor::Cloud, false}, resolution,
                                              makeProcedural(std::string(name), resolution));
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
