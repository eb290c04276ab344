#include "apps/view/light_ball.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/view/light_edits.h"
#include "apps/view/widgets.h"

namespace freevoxels {

namespace {

constexpr int kRings = 12, kSectors = 40;
constexpr double kDarkest = 0.03, kBrightest = 0.8;
constexpr ImU32 kDot = IM_COL32(255, 196, 64, 255), kEdge = IM_COL32(120, 128, 140, 255);

struct Disc {
  ImVec2 middle;
  float radius;

  ImVec2 at(glm::dvec2 place) const {
    return {middle.x + radius * float(place.x), middle.y - radius * float(place.y)};
  }
};

/// Triangles of rings around the middle, whose corners are shaded after Lambert.
void drawShaded(ImDrawList& list, const Disc& disc, glm::dvec3 direction, glm::dvec3 color) {
  const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
  const auto first = ImDrawIdx(list._VtxCurrentIdx);
  list.PrimReserve(6 * kRings * kSectors, (kRings + 1) * kSectors);
  for (int ring = 0; ring <= kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const double angle = 2.0 * std::numbers::pi * sector / kSectors;
      const glm::dvec2 place = double(ring) / kRings * glm::dvec2(std::cos(angle), std::sin(angle));
      const double light = std::max(glm::dot(directionOnBall(place), direction), 0.0);
      list.PrimWriteVtx(disc.at(place), white, shownColor(color * (kDarkest + kBrightest * light), 1.0f));
    }
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const int next = (sector + 1) % kSectors;
      const auto corner = [&](int r, int s) { return ImDrawIdx(first + r * kSectors + s); };
      for (const ImDrawIdx index : {corner(ring, sector), corner(ring + 1, sector), corner(ring + 1, next),
                                    corner(ring, sector), corner(ring + 1, next), corner(ring, next)})
        list.PrimWriteIdx(index);
    }
}

}  // namespace

bool drawLightBall(const char* name, float size, glm::dvec3& direction, glm::dvec3 color) {
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const Disc disc{{low.x + 0.5f * size, low.y + 0.5f * size}, 0.42f * size};
  ImGui::InvisibleButton(name, {size, size});
  hint("Drag to where the light comes from; past the edge: behind");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  drawShaded(list, disc, direction, color / std::max({color.r, color.g, color.b, 1.0}));
  list.AddCircle(disc.middle, disc.radius, kEdge, kSectors);
  const ImVec2 dot = disc.at(direction);
  const float radius = 0.05f * size;
  if (direction.z >= 0.0)
    list.AddCircleFilled(dot, radius, kDot);
  else
    list.AddCircle(dot, radius, kDot, 0, 1.5f);

  const ImGuiIO& io = ImGui::GetIO();
  if (!ImGui::IsItemActive() || (io.MouseDelta.x == 0.0f && io.MouseDelta.y == 0.0f)) return false;
  direction = directionOnBall(glm::dvec2(io.MousePos.x - disc.middle.x, disc.middle.y - io.MousePos.y) /
                              double(disc.radius));
  return true;
}

}  // namespace freevoxels
