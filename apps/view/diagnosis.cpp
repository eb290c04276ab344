#include "apps/view/diagnosis.h"

#include <algorithm>
#include <cmath>

#include "apps/view/block_picture.h"
#include "engine/core/error.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

namespace {

const glm::vec3 kNothingThere(0.02f, 0.03f, 0.06f);  // no grey, so that black and white stand out
const glm::vec3 kLeftOutColor(0.30f, 0.02f, 0.05f);
constexpr float kShownOpacity = 0.5f;  // of a voxel: the surface shows, without hard edges

Image greyPicture(const std::vector<SplatSums>& sums, glm::ivec2 size, double (*brightness)(const SplatSums&),
                  double scale) {
  Image image{.size = size};
  image.pixels.reserve(sums.size());
  for (const SplatSums& pixel : sums)
    image.pixels.emplace_back(glm::vec3(float(brightness(pixel) * scale)), 1.0f);
  return image;
}

Image sumsPicture(Shown shown, Renderer& renderer, const Camera& camera, const FrameSettings& settings) {
  FrameSettings ordered = settings;
  if (ordered.composite == Composite::Sorted) ordered.composite = Composite::Normalised;  // which has no sums
  const std::vector<SplatSums> sums = renderer.renderSums(camera, ordered);
  if (shown == Shown::Transmittance)
    return greyPicture(
        sums, settings.size, [](const SplatSums& pixel) { return std::exp(-pixel.depth); }, 1.0);
  const double largest = std::ranges::max(sums, {}, &SplatSums::energy).energy;
  return greyPicture(
      sums, settings.size, [](const SplatSums& pixel) { return pixel.energy; },
      largest > 0.0 ? 1.0 / largest : 0.0);
}

Image blocksPicture(const std::optional<Camera>& chosenFor, Renderer& renderer, const Volume& volume,
                    const Camera& camera, const FrameSettings& settings) {
  FrameSettings splats = settings;
  splats.draw = Draw::Splats;  // the gather chooses no blocks
  renderer.render(chosenFor.value_or(camera), splats);
  const std::vector<Block> drawn = renderer.downloadDrawnBlocks();
  std::vector<PaintedBlock> painted;
  for (const Block& block : drawn) painted.push_back({block, levelColor(block.level)});
  if (chosenFor) {
    std::vector<Block> voxels;
    const glm::ivec3 size = volume.dimensions;
    for (const std::uint32_t index : renderer.downloadBlockList()) {
      const int row = int(index / std::uint32_t(size.x));
      voxels.push_back({0, {int(index % std::uint32_t(size.x)), row % size.y, row / size.y}});
    }
    for (const Block& block : leftOut(drawn, voxels)) painted.push_back({block, kLeftOutColor});
  }
  return paintBlocks(painted, volume.dimensions, volume.indexToWorld, camera, settings.size);
}

/// Fitted into the picture, a voxel as large along both of its axes.
Image slicePicture(const Diagnosis& diagnosis, const std::vector<std::uint8_t>& codes, AttenuationCode code,
                   const Volume& volume, glm::ivec2 size) {
  const int across = diagnosis.axis, right = (across + 1) % 3, up = (across + 2) % 3;
  const glm::ivec3 count = volume.dimensions;
  const double pixels = std::min(double(size.x) / count[right], double(size.y) / count[up]);
  const glm::dvec2 corner = 0.5 * (glm::dvec2(size) - pixels * glm::dvec2(count[right], count[up]));
  Image image{.size = size};
  image.pixels.assign(std::size_t(size.x) * std::size_t(size.y), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec2 place = (glm::dvec2(x, size.y - 1 - y) + 0.5 - corner) / pixels;
      if (place.x < 0.0 || place.y < 0.0 || place.x >= count[right] || place.y >= count[up]) continue;
      glm::ivec3 voxel;
      voxel[across] = std::min(int(diagnosis.place * count[across]), count[across] - 1);
      voxel[right] = int(place.x);
      voxel[up] = int(place.y);
      const std::size_t index = volume.at(voxel.x, voxel.y, voxel.z);
      const bool held = volume.scalars.at(voxel) != kInactiveVoxel;
      const auto grey = float(std::exp(-decodeOpticalDepth(code, codes[index])));
      image.pixels[std::size_t(x) + std::size_t(size.x) * std::size_t(y)] =
          glm::vec4(held ? glm::vec3(grey) : kNothingThere, 1.0f);
    }
  return image;
}

/// Scalars are transmittances along a direction.
Volume transmittances(const Volume& volume, const std::vector<std::uint8_t>& codes, AttenuationCode code) {
  return makeVolume(volume.dimensions, volume.indexToWorld, [&](int x, int y, int z) {
    if (volume.scalar(x, y, z) == kInactiveVoxel) return kInactiveVoxel;
    return float(std::exp(-decodeOpticalDepth(code, codes[volume.at(x, y, z)])));
  });
}

}  // namespace

void Diagnoser::reset() {
  codes_.clear();
  tableRenderer_ = nullptr;
  tableDirection_ = -1;
}

const std::vector<std::vector<std::uint8_t>>& Diagnoser::codes(Renderer& renderer) {
  if (codes_.empty()) codes_ = renderer.downloadTable();
  return codes_;
}

Image Diagnoser::drawTable(int direction, Renderer& renderer, const Volume& volume,
                           const TableSettings& table, const Camera& camera, glm::ivec2 size) {
  if (!tableRenderer_ || tableDirection_ != direction) {
    Classification classification;
    classification.transferFunction =
        TransferFunction{.opacity = {{0.0f, kShownOpacity}},
                         .color = {{0.0f, glm::vec3(0.0f)}, {1.0f, glm::vec3(1.0f)}},
                         .unitDistance = volume.voxelSize()};
    tableRenderer_ = nullptr;  // not both at once
    tableVolume_ = transmittances(volume, codes(renderer)[std::size_t(direction)], table.code);
    tableRenderer_ = std::make_unique<Renderer>(device_, tableVolume_, classification, table);
    tableDirection_ = direction;
  }
  Image image = tableRenderer_->render(camera, {.size = size});
  for (glm::vec4& pixel : image.pixels) pixel += glm::vec4((1.0f - pixel.a) * kNothingThere, 1.0f - pixel.a);
  return image;
}

Image Diagnoser::make(const Diagnosis& diagnosis, Renderer& renderer, const Volume& volume,
                      const TableSettings& table, const Camera& camera, const FrameSettings& settings) {
  const int direction = std::min(diagnosis.direction, directionCount(table.directions) - 1);
  switch (diagnosis.shown) {
    case Shown::Energy:
    case Shown::Transmittance:
      return sumsPicture(diagnosis.shown, renderer, camera, settings);
    case Shown::Blocks:
      return blocksPicture(diagnosis.chosenFor, renderer, volume, camera, settings);
    case Shown::TableSlice:
      return slicePicture(diagnosis, codes(renderer)[std::size_t(direction)], table.code, volume,
                          settings.size);
    case Shown::TablePicture:
      return drawTable(direction, renderer, volume, table, camera, settings.size);
    case Shown::Picture:
      break;
  }
  throw InternalError("a picture is no diagnosis");
}

}  // namespace freevoxels
