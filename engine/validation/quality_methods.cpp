#include "engine/validation/quality_methods.h"

#include <algorithm>

#include "engine/core/error.h"

namespace freevoxels {

const std::vector<QualityMethod>& qualityMethods() {
  static const std::vector<QualityMethod> methods{
      {.name = "default",
       .table = {},
       .frame = {},
       .order = ClassificationOrder::Post,
       .goals = {.mean = 44.0, .least = 40.0, .leastThin = 26.0, .notBelowSorted = true}},
      {.name = "classified before", .table = {}, .frame = {}, .goals = {}},
      {.name = "splats", .table = {}, .frame = {.method = SplatSettings{}}, .goals = {}},
      {.name = "splats, 98 directions",
       .table = {.directions = DirectionSet::Directions98},
       .frame = {.method = SplatSettings{}},
       .goals = {}},
      {.name = "no gradient", .table = {}, .frame = {.method = SplatSettings{.gradient = false}}, .goals = {}},
      {.name = "nearest, additive (paper)",
       .table = {.code = AttenuationCode::Linear8, .pathLengthCorrection = false},
       .frame = {.method = SplatSettings{.composite = Composite::Additive, .attenuation = AttenuationLookup::Nearest, .gradient = false}},
       .goals = {}},
      {.name = "bilinear, additive", .table = {}, .frame = {.method = SplatSettings{.composite = Composite::Additive}}, .goals = {}},
      {.name = "sorted", .table = {}, .frame = {.method = SplatSettings{.composite = Composite::Sorted}}, .goals = {}}};
  return methods;
}

std::size_t sortedMethod(const std::vector<QualityMethod>& methods) {
  const auto sorted = std::ranges::find_if(methods, [](const QualityMethod& method) { return method.frame.isSorted(); });
  const auto index = std::size_t(sorted - methods.begin());
  FV_CHECK_LT(index, methods.size());
  return index;
}

}  // namespace freevoxels
