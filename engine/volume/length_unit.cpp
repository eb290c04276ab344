#include "engine/volume/length_unit.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

namespace freevoxels {

namespace {

struct LengthUnit {
  double millimetres;
  std::initializer_list<std::string_view> names;
};

}  // namespace

std::optional<double> millimetresOf(const std::string& unit) {
  static const std::array<LengthUnit, 10> kUnits{
      {{1e-7, {"angstrom", "\u00c5", "\u212b"}},
       {1e-9, {"picometer", "pm"}},
       {1e-6, {"nanometer", "nm"}},
       {1e-3, {"micrometer", "micrometre", "micron", "microns", "um", "\u00b5m", "\u03bcm", "\\u00B5m"}},
       {1.0, {"millimeter", "mm"}},
       {10.0, {"centimeter", "cm"}},
       {1000.0, {"meter", "m"}},
       {1e6, {"kilometer", "km"}},
       {25.4, {"inch", "in"}},
       {304.8, {"foot", "ft"}}}};
  for (const LengthUnit& one : kUnits)
    if (std::ranges::find(one.names, unit) != one.names.end()) return one.millimetres;
  return std::nullopt;
}

}  // namespace freevoxels
