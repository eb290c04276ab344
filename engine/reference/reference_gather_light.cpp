// What lit samples of a gathered frame read.

#include "engine/core/error.h"
#include "engine/reference/reference_depth.h"
#include "engine/reference/reference_gather_ray.h"
#include "engine/reference/reference_light.h"
#include "engine/reference/reference_rays.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

std::vector<double> referenceLightDepths(const Volume& volume, std::span<const double> extinction, const LevelData& medium, int level,
                                         const Light& light) {
  const RaySource source = lightSource(light, volume.indexToWorld);
  const auto depths = rayDepth(volume, source, referenceRays(volume, extinction, source));
  std::vector<double> result;
  glm::ivec3 cell;
  for (cell.z = 0; cell.z < medium.dimensions.z; ++cell.z)
    for (cell.y = 0; cell.y < medium.dimensions.y; ++cell.y)
      for (cell.x = 0; cell.x < medium.dimensions.x; ++cell.x) {
        const Block block{level, cell};
        const glm::dvec3 way = source.atInfinity ? source.place : source.place - boxOf(block, volume.dimensions).centre();
        const double layer = glm::length(glm::dmat3(volume.indexToWorld) * (way / std::abs(way[majorAxis(way)])));
        // Rays have what is in front of a layer.
        result.push_back(depths->at(block) + 0.5 * layer * medium.extinction[medium.at(cell)]);
      }
  return result;
}

std::vector<glm::dvec3> referenceGradients(std::span<const double> values, glm::ivec3 dimensions, bool continued) {
  std::vector<glm::dvec3> gradients;
  glm::ivec3 block;
  for (block.z = 0; block.z < dimensions.z; ++block.z)
    for (block.y = 0; block.y < dimensions.y; ++block.y)
      for (block.x = 0; block.x < dimensions.x; ++block.x) {
        const double outside = continued ? values[indexOf(block, dimensions)] : 0.0;
        glm::dvec3 sum(0.0);
        for (int i = 0; i < 27; ++i) {
          const glm::ivec3 offset = glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1, next = block + offset;
          const bool within = glm::all(glm::greaterThanEqual(next, glm::ivec3(0))) && glm::all(glm::lessThan(next, dimensions));
          const double value = within ? values[indexOf(next, dimensions)] : outside;
          const glm::dvec3 smoothing = 2.0 - glm::abs(glm::dvec3(offset));  // 1 2 1 across the derivative's axis
          for (int axis = 0; axis < 3; ++axis)
            sum[axis] += value * offset[axis] * smoothing[(axis + 1) % 3] * smoothing[(axis + 2) % 3];
        }
        gradients.push_back(sum / 32.0);
      }
  return gradients;
}

std::vector<double> referenceScalars(const Volume& volume, const Classification& classification) {
  const TransferTable table(*classification.transferFunction, volume.minimum, volume.maximum);
  std::vector<double> result;
  for (std::size_t i = 0; i < volume.voxelCount(); ++i) {
    const glm::ivec3 n = volume.dimensions;
    const int code = table.code(volume.scalars.at({int(i) % n.x, int(i) / n.x % n.y, int(i) / n.x / n.y}));
    FV_CHECK_LT(0, code);
    result.push_back(double(code - 1) * shader::kTransferIntervals / shader::kScalarCodes);
  }
  return result;
}

}  // namespace freevoxels
