#include "engine/volume/grid_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <string>
#include <utility>

namespace freevoxels {

namespace {

using Names = std::span<const std::string_view>;

// In the order of preference; letters and digits in lower case.
constexpr std::array<std::string_view, 9> kDensities{"density",      "smoke",           "smokedensity", "densitysmoke", "fogdensity",
                                                     "voxeldensity", "voxelfogdensity", "fog",          "soot"};
constexpr std::array<std::string_view, 12> kTemperatures{"temperature", "voxeltemperature", "temp",          "heat",
                                                         "flame",       "flames",           "fire",          "burn",
                                                         "burning",     "flameintensity",   "fireintensity", "combustion"};
constexpr int kFirstFlame = 4;
constexpr std::array<std::string_view, 9> kColors{"cd", "color", "colour", "colors", "colours", "scatter", "scattering", "albedo", "rgb"};
constexpr std::array<std::string_view, 23> kOthers{
    "fuel", "oxygen", "react", "pressure", "divergence", "vorticity", "speed",     "shadow",    "age",       "life", "viscosity", "mask",
    "phi",  "velx",   "vely",  "velz",     "velocityx",  "velocityy", "velocityz", "obstacles", "collision", "sdf",  "surface"};

std::string plain(std::string_view name) {
  std::string letters;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) letters += char(std::tolower(static_cast<unsigned char>(c)));
  constexpr std::string_view kSuffix = "grid";  // which says nothing
  if (letters.size() > kSuffix.size() && letters.ends_with(kSuffix)) letters.resize(letters.size() - kSuffix.size());
  return letters;
}

}  // namespace

NamedRole roleOfName(std::string_view name) {
  const std::string letters = plain(name);
  for (const auto& [role, names] : {std::pair(GridRole::Density, Names(kDensities)),
                                    {GridRole::Temperature, Names(kTemperatures)},
                                    {GridRole::Color, Names(kColors)},
                                    {GridRole::Other, Names(kOthers)}})
    if (const auto found = std::ranges::find(names, letters); found != names.end()) {
      const int rank = int(found - names.begin());
      return {.role = role, .rank = rank, .isFlame = role == GridRole::Temperature && rank >= kFirstFlame};
    }
  constexpr std::string_view kComponents = "xyzrgb";
  if (letters.size() > 1 && kComponents.find(letters.back()) != std::string_view::npos &&
      std::ranges::find(kColors, std::string_view(letters).substr(0, letters.size() - 1)) != kColors.end())
    return {.role = GridRole::ColorComponent};
  return {};
}

}  // namespace freevoxels
