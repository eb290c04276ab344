#include "engine/octree/device_scalars.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>
#include <tuple>
#include <vector>

#include "engine/volume/transfer_table.h"

namespace freevoxels {

DeviceScalars uploadScalars(const Device& device, const Volume& volume, const TransferFunction& function,
                            double extinctionScale) {
  using Codes = ScalarBricks::BrickOf<std::uint16_t>;
  const ScalarBricks& scalars = volume.scalars;
  DeviceScalars result;
  result.cells = scalars.cells();
  result.corner = scalars.corner();

  const TransferTable table(function, volume.minimum, volume.maximum);
  result.low = table.low();
  result.high = table.high();
  std::vector<std::uint32_t> numbers(std::size_t(result.cells.x) * std::size_t(result.cells.y) * std::size_t(result.cells.z), 0);
  for (std::size_t i = 0; i < scalars.count(); ++i) {
    const glm::ivec3 cell = scalars.cell(i);
    numbers[std::size_t(cell.x + result.cells.x * (cell.y + result.cells.y * cell.z))] = std::uint32_t(i + 1);
  }

  result.codes =
      Buffer(device, (scalars.count() + 1) * sizeof(Codes), MemoryUse::Device, "scalar codes", VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  const auto codeOf = [&](float scalar) { return table.code(scalar); };
  const auto codeOfValue = scalars.mapValues<std::uint16_t>(codeOf);
  upload(device, result.codes, result.codes.bytes(), [&](std::span<std::byte> piece, VkDeviceSize first) {
    const std::span<Codes> bricks(reinterpret_cast<Codes*>(piece.data()), piece.size() / sizeof(Codes));
    tbb::parallel_for(std::size_t(0), bricks.size(), [&](std::size_t i) {
      if (const std::size_t brick = first / sizeof(Codes) + i; brick == 0)
        bricks[i].fill(0);
      else
        scalars.mapBrick(brick - 1, std::span<std::uint16_t>(bricks[i]), codeOf, std::span<const std::uint16_t>(codeOfValue));
    });
  });
  result.brickNumbers = Buffer(device, numbers.size() * sizeof(std::uint32_t), MemoryUse::Device, "scalar brick numbers",
                               VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  upload(device, result.brickNumbers, std::as_bytes(std::span(numbers)));
  const std::vector<glm::vec4> texels = table.texels(extinctionScale);
  std::tie(result.table, result.tableTexels) =
      uploadTexels(device, std::as_bytes(std::span(texels)), VK_FORMAT_R32G32B32A32_SFLOAT, "transfer function table");
  if (std::max<std::uint64_t>(result.codes.bytes() / sizeof(std::uint32_t), numbers.size()) <= device.limits().maxTexelBufferElements) {
    result.codeTexels.emplace(device, result.codes, VK_FORMAT_R32_UINT);
    result.numberTexels.emplace(device, result.brickNumbers, VK_FORMAT_R32_UINT);
  }
  return result;
}

bool DeviceScalars::reclassify(const Device& device, const Volume& volume, const TransferFunction& function, double extinctionScale) {
  const TransferTable other(function, volume.minimum, volume.maximum);
  if (other.low() != low || other.high() != high) return false;
  const std::vector<glm::vec4> texels = other.texels(extinctionScale);
  upload(device, table, std::as_bytes(std::span(texels)));
  return true;
}

shader::CodeBricks DeviceScalars::onDevice() const {
  return {.numbers = addressWords(brickNumbers.address()), .codes = addressWords(codes.address()), .corner = corner, .cells = cells};
}

}  // namespace freevoxels
