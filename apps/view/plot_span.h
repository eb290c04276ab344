#pragma once
// Shared by the plots of a transfer function: the mapping of x to the screen, and the point under the mouse.

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace freevoxels {

/// Radius of points in units of the font size; the plots leave as much space at their ends.
inline constexpr float kPointRadius = 0.38f;

/// x in 0..1 from `low` to `high`, on the screen.
struct PlotSpan {
  float low, high;

  float at(double x) const { return low + float(x) * (high - low); }
  double x(float pixel) const { return std::clamp(double((pixel - low) / (high - low)), 0.0, 1.0); }
};

/// The nearest point under the mouse. `placeOf(point)` is its position on the screen.
template <typename Points, typename PlaceOf>
std::optional<std::size_t> pointUnderMouse(const Points& points, const PlaceOf& placeOf) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  float least = 2.0f * kPointRadius * ImGui::GetFontSize();
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ImVec2 place = placeOf(points[i]);
    const float distance = std::hypot(place.x - mouse.x, place.y - mouse.y);
    if (distance > least) continue;
    least = distance;
    found = i;
  }
  return found;
}

}  // namespace freevoxels
