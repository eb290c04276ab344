#include "engine/octree/device_scalars.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>
#include <vector>

#include "engine/volume/transfer_table.h"

namespace freevoxels {

DeviceScalars uploadScalars(const Device& device, const Volume& volume, const TransferFunction& function,
                            double extinctionScale) {
  constexpr std::size_t kVoxels = std::tuple_size_v<ScalarBricks::Brick>;
  const ScalarBricks& scalars = volume.scalars;
  const std::span<const ScalarBricks::Brick> bricks = scalars.bricks();
  DeviceScalars result;
  result.cells = scalars.cells();
  result.corner = scalars.corner();

  const TransferTable table(function, volume.minimum, volume.maximum);
  std::vector<std::uint16_t> codes((bricks.size() + 1) * kVoxels, 0);
  std::vector<std::uint32_t> numbers(std::size_t(result.cells.x) * std::size_t(result.cells.y) * std::size_t(result.cells.z), 0);
  tbb::parallel_for(std::size_t(0), bricks.size(), [&](std::size_t i) {
    std::ranges::transform(bricks[i], codes.begin() + std::ptrdiff_t((i + 1) * kVoxels),
                           [&](float scalar) { return table.code(scalar); });
    const glm::ivec3 cell = scalars.cell(i);
    numbers[std::size_t(cell.x + result.cells.x * (cell.y + result.cells.y * cell.z))] = std::uint32_t(i + 1);
  });
  const std::vector<glm::vec4> texels = table.texels(extinctionScale);

  const auto make = [&](std::span<const std::byte> bytes, const char* name) {
    Buffer buffer(device, bytes.size(), MemoryUse::Device, name, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    upload(device, buffer, bytes);
    return buffer;
  };
  result.codes = make(std::as_bytes(std::span(codes)), "scalar codes");
  result.brickNumbers = make(std::as_bytes(std::span(numbers)), "scalar brick numbers");
  result.table = make(std::as_bytes(std::span(texels)), "transfer function table");
  result.tableTexels = TexelView(device, result.table);
  if (std::max(codes.size() / 2, numbers.size()) <= device.limits().maxTexelBufferElements) {
    result.codeTexels.emplace(device, result.codes, VK_FORMAT_R32_UINT);
    result.numberTexels.emplace(device, result.brickNumbers, VK_FORMAT_R32_UINT);
  }
  return result;
}

shader::CodeBricks DeviceScalars::onDevice() const {
  return {.numbers = addressWords(brickNumbers.address()), .codes = addressWords(codes.address()), .corner = corner, .cells = cells};
}

}  // namespace freevoxels
