#pragma once
// What a value of the volume looks like: its density, or a transfer function.

#include <string>

#include "apps/view/async_value.h"
#include "apps/view/color_strip.h"
#include "apps/view/opacity_curve.h"
#include "apps/view/transfer_model.h"
#include "apps/view/view_state.h"
#include "apps/view/widgets.h"

namespace freevoxels {

/// So many that a narrow window of values still has some.
inline constexpr int kHistogramBins = 2048;

class ClassificationPanel {
 public:
  void draw(ViewState& state);
  /// For the histogram.
  bool waits() const { return histogram_.isMaking(); }

 private:
  void follow(ViewState& state);
  /// The points, and the preset, of curves that are no more.
  void deselect();
  void drawKind(ViewState& state);
  void drawDensity(ViewState& state);
  void drawTransferFunction(ViewState& state);
  bool drawPresets(const Volume& volume);
  bool drawRange(const Volume& volume);
  bool drawFile(ViewState& state);

  AsyncValue<std::shared_ptr<const Volume>, Histogram> histogram_{
      [](const std::shared_ptr<const Volume>& volume) { return histogramOf(*volume, kHistogramBins); }};
  AutomaticSlider scale_, unitDistance_;
  OpacityCurve curve_;
  ColorStrip strip_;

  std::string volume_;             ///< the source of the one that the rest is of
  ClassificationOptions density_;  ///< as they were before there was a transfer function
  TransferModel model_;
  std::string modelText_;  ///< of the option that model_ was read from, or written to
  std::string file_, preset_;
};

}  // namespace freevoxels
