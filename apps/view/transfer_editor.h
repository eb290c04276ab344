#pragma once
// The plots of a transfer function, whose points can be dragged: opacity over the histogram, and colours.

#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <optional>

#include "apps/view/transfer_model.h"
#include "engine/volume/histogram.h"

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

class OpacityCurve {
 public:
  /// `range` are the scalars at x = 0 and 1; `histogram` may be null. Returns true if the model was changed.
  bool draw(TransferModel& model, glm::dvec2 range, const Histogram* histogram);

 private:
  struct Frame {
    PlotSpan span;
    float top, bottom;

    /// The axis is one of cube roots, because small opacities matter.
    float y(double alpha) const { return bottom + float(std::cbrt(alpha)) * (top - bottom); }
    double alpha(float pixel) const {
      return std::pow(std::clamp(double((pixel - bottom) / (top - bottom)), 0.0, 1.0), 3.0);
    }
  };

  bool handle(TransferModel& model, const Frame& frame);
  bool remove(TransferModel& model, std::size_t point);
  void drawPoints(const TransferModel& model, const Frame& frame) const;
  bool drawFields(TransferModel& model, glm::dvec2 range);

  std::optional<std::size_t> selected_;
};

class ColorStrip {
 public:
  /// True where the model was changed.
  bool draw(TransferModel& model);

 private:
  bool handle(TransferModel& model, const PlotSpan& span, float y);
  bool remove(TransferModel& model, std::size_t point);

  std::optional<std::size_t> selected_;
};

}  // namespace freevoxels
