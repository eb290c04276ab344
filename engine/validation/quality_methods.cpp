#include "engine/validation/quality_methods.h"

#include <algorithm>

#include "engine/core/error.h"

namespace freevoxels {

const std::vector<QualityMethod>& qualityMethods() {
  static const std::vector<QualityMethod> methods{
      {.name = "default",
       .table = {},
       .frame = {.draw = Draw::Gather},
       .order = ClassificationOrder::Post,
       .goals = {.mean = 44.0, .least = 40.0, .leastThin = 26.0, .notBelowSorted = true}},
      {.name = "classified before", .table = {}, .frame = {.draw = Draw::Gather}, .goals = {}},
      {.name = "splats", .table = {}, .frame = {}, .goals = {}},
      {.name = "splats, 98 directions", .table = {.directions = DirectionSet::Directions98}, .frame = {}, .goals = {}},
      {.name = "splats, exact", .table = {}, .frame = {.attenuation = AttenuationLookup::Exact}, .goals = {}},
      {.name = "no gradient", .table = {}, .frame = {.gradient = false}, .goals = {}},
      {.name = "nearest, additive (paper)",
       .table = {.code = AttenuationCode::Linear8, .pathLengthCorrection = false},
       .frame = {.composite = Composite::Additive,
                 .attenuation = AttenuationLookup::Nearest,
                 .gradient = false},
       .goals = {}},
      {.name = "bilinear, additive", .table = {}, .frame = {.composite = Composite::Additive}, .goals = {}},
      {.name = "sorted", .table = {}, .frame = {.composite = Composite::Sorted}, .goals = {}}};
  return methods;
}

std::size_t sortedMethod(const std::vector<QualityMethod>& methods) {
  const auto sorted = std::ranges::find(methods, Composite::Sorted,
                                        [](const QualityMethod& method) { return method.frame.composite; });
  const auto index = std::size_t(sorted - methods.begin());
  FV_CHECK_LT(index, methods.size());
  return index;
}

}  // namespace freevoxels
