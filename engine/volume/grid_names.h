#pragma once
// What the grids of a volume's file are by their names, as the programs that write OpenVDB files call them: Houdini, Blender (Mantaflow),
// EmberGen, PhoenixFD, FumeFX, Bifrost, Omniverse Flow.

#include <string_view>

namespace freevoxels {

enum class GridRole {
  Unknown,      ///< may be anything
  Density,      ///< of smoke or fog
  Temperature,  ///< of which emission is made, in any unit: temperatures, heat and the intensity of flames
  Color,
  ColorComponent,  ///< one of three grids of a colour's components: "Cd.x"
  Other,           ///< what is none of these: fuel, pressure, parts of velocities, ...
};

struct NamedRole {
  GridRole role = GridRole::Unknown;
  int rank = 0;          ///< among the names of a role: the lowest is preferred
  bool isFlame = false;  ///< whether it has the intensity of flames, which is 0 where nothing burns
};

/// Case, the characters between letters and digits, and "grid" at the end mean nothing.
NamedRole roleOfName(std::string_view name);

}  // namespace freevoxels
