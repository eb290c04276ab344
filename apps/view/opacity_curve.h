#pragma once
// The opacity of a transfer function over the histogram of a volume, with points that can be dragged.

#include <imgui.h>

#include <optional>

#include "apps/view/plot_span.h"
#include "apps/view/transfer_model.h"
#include "engine/volume/histogram.h"

namespace freevoxels {

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

}  // namespace freevoxels
