// Which types of grids can be drawn.
#include "engine/volume/vdb_grids.h"

#include <fmt/format.h>

#include <cmath>

namespace freevoxels {

using openvdb::GridBase;

namespace {

bool isWholeType(const std::string& valueType) {
  return valueType == "int32" || valueType == "int64" || valueType == "bool" || valueType == "mask";
}

}  // namespace

bool isScalar(const VdbFile::Entry& entry) {
  return whyTypeUnusable(entry.treeType, entry.valueType).empty() && !isWhole(entry);
}

bool isWhole(const VdbFile::Entry& entry) {
  return isWholeType(entry.valueType);
}

bool isColor(const VdbFile::Entry& entry) {
  return entry.valueType == "vec3s" || entry.valueType == "vec3h" || entry.valueType == "vec3d";
}

std::string whyTypeUnusable(const std::string& treeType, const std::string& valueType) {
  if (valueType == "point data" || valueType == "point index")
    return "it holds points, not a density field; rasterise the points to a density grid first";
  if (!GridBase::isRegistered(treeType))
    return fmt::format("this OpenVDB does not know grids of type '{}'; convert it to a float grid",
                       oneLine(treeType));
  if (valueType == "float" || valueType == "half" || valueType == "double" || isWholeType(valueType)) return {};
  if (valueType.starts_with("vec"))
    return fmt::format("it holds vectors ({}), not densities; choose a float grid", valueType);
  return fmt::format("it holds values of type {}, not densities; choose a float grid", valueType);
}

std::string whyTransformUnusable(const openvdb::math::Transform& transform) {
  constexpr const char* kSingular =
      "its transform is singular or not finite; give the grid a transform with voxels of some volume";
  if (!transform.isLinear())
    return "its transform is a frustum; resample it to a box with an affine transform";
  openvdb::Mat4d matrix;
  try {
    matrix = transform.baseMap()->getAffineMap()->getMat4();
  } catch (const openvdb::ArithmeticError&) {  // a transform of scales alone is not checked before this
    return kSingular;
  }
  double lengths = 1.0;
  for (int row = 0; row < 3; ++row)
    lengths *= openvdb::Vec3d(matrix(row, 0), matrix(row, 1), matrix(row, 2)).length();
  constexpr double kFlattest = 1e-9;  // volume of a voxel relative to the box of its edge lengths
  const double volume = std::abs(matrix.getMat3().det());
  const bool finite = std::isfinite(lengths) && std::isfinite(volume) && matrix.getTranslation().isFinite();
  return finite && volume > kFlattest * lengths ? "" : kSingular;
}

openvdb::FloatGrid::ConstPtr asFloatGrid(const GridBase::ConstPtr& grid) {
  using openvdb::FloatGrid;
  if (const auto floats = openvdb::gridConstPtrCast<FloatGrid>(grid)) return floats;
  if (const auto doubles = openvdb::gridConstPtrCast<openvdb::DoubleGrid>(grid))
    return std::make_shared<const FloatGrid>(*doubles);
  if (const auto numbers = openvdb::gridConstPtrCast<openvdb::Int32Grid>(grid)) return std::make_shared<const FloatGrid>(*numbers);
  if (const auto numbers = openvdb::gridConstPtrCast<openvdb::Int64Grid>(grid)) return std::make_shared<const FloatGrid>(*numbers);
  if (const auto truths = openvdb::gridConstPtrCast<openvdb::BoolGrid>(grid)) return std::make_shared<const FloatGrid>(*truths);
  if (const auto mask = openvdb::gridConstPtrCast<openvdb::MaskGrid>(grid)) {
    const auto floats = FloatGrid::create(std::make_shared<openvdb::FloatTree>(mask->tree(), 0.0f, 1.0f, openvdb::TopologyCopy()));
    floats->setTransform(mask->transform().copy());
    return floats;
  }
#if OPENVDB_LIBRARY_MAJOR_VERSION_NUMBER >= 13  // the first with half grids in memory
  if (const auto halves = openvdb::gridConstPtrCast<openvdb::HalfGrid>(grid))
    return std::make_shared<const FloatGrid>(*halves);
#endif
  return nullptr;
}

}  // namespace freevoxels
